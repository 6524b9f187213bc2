find_package(rostest REQUIRED)

early_fusion_add_test(ros acting_policy_test)
early_fusion_add_test(ros camera_image_test)
early_fusion_add_test(ros conversions_test)
early_fusion_add_test(ros markers_test)
early_fusion_add_test(ros rollout_recorder_test)

add_library(early_fusion_child_process STATIC ros/child_process.cpp)
target_link_libraries(early_fusion_child_process early_fusion_settings)

# A node with a test in the place of its partners: ros/<name>.test and ros/<name>_rostest.cpp.
function(early_fusion_add_rostest name)
  add_rostest_gtest(${name}_rostest ros/${name}.test ros/${name}_rostest.cpp)
  target_link_libraries(${name}_rostest early_fusion_ros ${ARGN} gtest)
  add_dependencies(build_tests ${name}_rostest)
endfunction()

early_fusion_add_rostest(policy_node)
early_fusion_add_rostest(real_camera)
early_fusion_add_rostest(simulator_node)
early_fusion_add_rostest(node_parameters early_fusion_child_process gtest_main)
target_compile_definitions(node_parameters_rostest PRIVATE EARLY_FUSION_NODES="$<TARGET_FILE_DIR:simulator_node>")

# Whole sessions bring up masters of their own.
early_fusion_add_test(ros session_test early_fusion_child_process nlohmann_json::nlohmann_json)
