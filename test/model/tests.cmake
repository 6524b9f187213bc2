early_fusion_add_test(model action_choice_test)
early_fusion_add_test(model goal_policy_test)
early_fusion_add_test(model saliency_test)

# The second implementation that the network is checked against.
if(Torch_FOUND)
  early_fusion_add_test(model libtorch_parity_test torch torch_cpu c10)
  target_include_directories(model_libtorch_parity_test SYSTEM PRIVATE ${TORCH_INCLUDE_DIRS})
endif()
