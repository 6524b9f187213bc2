early_fusion_add_test(model action_choice_test)
early_fusion_add_test(model attention_map_test)
early_fusion_add_test(model early_fusion_test)
early_fusion_add_test(model golden_parity_test)
early_fusion_add_test(model late_fusion_test)
early_fusion_add_test(model network_policy_test)
early_fusion_add_test(model policy_file_test)
early_fusion_add_test(model policy_head_test)
early_fusion_add_test(model policy_kinds_test)
early_fusion_add_test(model policy_options_test)
early_fusion_add_test(model request_encoder_test)
early_fusion_add_test(model saliency_test)
early_fusion_add_test(model sample_batch_test)
early_fusion_add_test(model second_branch_test)
early_fusion_add_test(model vision_trunk_test)
early_fusion_add_test(model warm_start_test)

# OpenCV reads the exported network. It sees the frames of an episode.
if(TARGET opencv_dnn)
  early_fusion_add_test(model policy_export_test ${PROJECT_NAME}_learning opencv_core opencv_dnn)
else()
  early_fusion_skip_test(model_policy_export_test
    "OpenCV's module dnn was not found when the build was configured (Debian: libopencv-dnn-dev)")
endif()

# The second implementation that the network is checked against.
foreach(name libtorch_golden_test libtorch_parity_test libtorch_weights_test)
  if(Torch_FOUND)
    early_fusion_add_test(model ${name} torch torch_cpu c10 nlohmann_json::nlohmann_json)
    target_include_directories(model_${name} SYSTEM PRIVATE ${TORCH_INCLUDE_DIRS})
  else()
    early_fusion_skip_test(model_${name} "libtorch was not found when the build was configured (Debian: libtorch-dev)")
  endif()
endforeach()

foreach(name attention_map_test early_fusion_test golden_parity_test late_fusion_test network_policy_test
    libtorch_parity_test vision_trunk_test)
  early_fusion_add_eigen_test(model_${name})
endforeach()
