catkin_add_gtest(cli_command_line_test cli/command_line_test.cpp)
target_link_libraries(cli_command_line_test ${PROJECT_NAME}_learning nlohmann_json::nlohmann_json opencv_core
  opencv_imgcodecs gtest_main)
target_compile_definitions(cli_command_line_test PRIVATE EARLY_FUSION_PROGRAM="$<TARGET_FILE:${PROJECT_NAME}_cli>")
add_dependencies(cli_command_line_test ${PROJECT_NAME}_cli)

catkin_add_gtest(cli_experiment_command_test cli/experiment_command_test.cpp)
target_include_directories(cli_experiment_command_test PRIVATE ${PROJECT_SOURCE_DIR}/test)
target_link_libraries(cli_experiment_command_test ${PROJECT_NAME}_experiment gtest_main)
target_compile_definitions(cli_experiment_command_test PRIVATE EARLY_FUSION_PROGRAM="$<TARGET_FILE:${PROJECT_NAME}_cli>")
add_dependencies(cli_experiment_command_test ${PROJECT_NAME}_cli)

add_test(NAME cli_export_test COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/cli/export_test.py
                                      ${PROJECT_SOURCE_DIR} $<TARGET_FILE:${PROJECT_NAME}_cli>)
set_tests_properties(cli_export_test PROPERTIES SKIP_RETURN_CODE 77)
