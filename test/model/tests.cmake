early_fusion_add_test(model action_choice_test)
early_fusion_add_test(model goal_policy_test)
early_fusion_add_test(model golden_parity_test)
early_fusion_add_test(model saliency_test)

# The second implementation that the network is checked against.
foreach(name libtorch_golden_test libtorch_parity_test)
  if(Torch_FOUND)
    early_fusion_add_test(model ${name} torch torch_cpu c10)
    target_include_directories(model_${name} SYSTEM PRIVATE ${TORCH_INCLUDE_DIRS})
  else()
    early_fusion_skip_test(model_${name} "libtorch was not found when the build was configured (Debian: libtorch-dev)")
  endif()
endforeach()
