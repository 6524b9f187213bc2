foreach(test adam_test conv_block_test convolution_test dropout_test frame_stack_test gradient_test lanes_test linear_test
    parameters_test pooling_test softmax_cross_entropy_test weights_file_test)
  early_fusion_add_test(nn ${test})
endforeach()
