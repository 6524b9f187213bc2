find_package(rostest QUIET)

add_library(${PROJECT_NAME}_child_process STATIC ros/child_process.cpp)
target_link_libraries(${PROJECT_NAME}_child_process ${PROJECT_NAME}_settings)

foreach(name acting_policy camera_crop camera_image conversions correction_recorder files_folder joint_stepper markers
    option_tables pan_tilt_stepper presses request_list request_pairing rollout_recorder sight_line stamps standstill
    take_over topic_watch transform_gate virtual_camera virtual_joint wall_throttle)
  early_fusion_add_test(ros ${name}_test)
  target_include_directories(ros_${name}_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
endforeach()

early_fusion_add_test(ros launch_files_test ${PROJECT_NAME}_child_process yaml-cpp)
target_include_directories(ros_launch_files_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
add_dependencies(ros_launch_files_test ${PROJECT_NAME}_cli)

# Whole sessions bring up masters of their own.
early_fusion_add_test(ros session_test ${PROJECT_NAME}_child_process nlohmann_json::nlohmann_json)

early_fusion_add_test(ros correct_launch_test ${PROJECT_NAME}_child_process)
target_include_directories(ros_correct_launch_test SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})

# A node with a test in the place of its partners: ros/<name>.test and ros/<name>_rostest.cpp.
foreach(name node_parameters pan_tilt_driver policy_node real_camera simulator_node tf_scene tracked_session
    virtual_path virtual_robot)
  if(rostest_FOUND)
    add_rostest_gtest(${name}_rostest ros/${name}.test ros/${name}_rostest.cpp)
    target_include_directories(${name}_rostest PRIVATE ${PROJECT_SOURCE_DIR}/test)
    target_include_directories(${name}_rostest SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
    target_link_libraries(${name}_rostest ${PROJECT_NAME}_ros ${PROJECT_NAME}_child_process gtest)
  else()
    early_fusion_skip_test(${name}_rostest "rostest was not found when the build was configured")
  endif()
endforeach()
if(rostest_FOUND)
  target_sources(real_camera_rostest PRIVATE ros/real_camera_faults_rostest.cpp)
  add_rostest(ros/tf_scene_none.test DEPENDENCIES tf_scene_rostest)
  add_rostest(ros/tracked_session_noise.test DEPENDENCIES tracked_session_rostest)
  add_rostest(ros/virtual_path_trajectory.test DEPENDENCIES virtual_path_rostest)
  target_link_libraries(node_parameters_rostest gtest_main)
  target_compile_definitions(node_parameters_rostest PRIVATE EARLY_FUSION_NODES="$<TARGET_FILE_DIR:simulator_node>")
endif()
