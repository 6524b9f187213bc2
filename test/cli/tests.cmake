catkin_add_gtest(cli_command_line_test cli/command_line_test.cpp)
target_link_libraries(cli_command_line_test ${PROJECT_NAME}_learning nlohmann_json::nlohmann_json opencv_core
  opencv_imgcodecs gtest_main)
target_compile_definitions(cli_command_line_test PRIVATE EARLY_FUSION_PROGRAM="$<TARGET_FILE:${PROJECT_NAME}_cli>")
add_dependencies(cli_command_line_test ${PROJECT_NAME}_cli)
