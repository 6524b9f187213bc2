add_test(NAME scripts_analyse_trace_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/analyse_trace_test.py
                 ${PROJECT_SOURCE_DIR} $<TARGET_FILE:${PROJECT_NAME}_cli>)
add_test(NAME scripts_animate_episode_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/animate_episode_test.py
                 ${PROJECT_SOURCE_DIR} $<TARGET_FILE:${PROJECT_NAME}_cli>)
set_tests_properties(scripts_animate_episode_test PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME scripts_documents_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/documents_test.py ${PROJECT_SOURCE_DIR})
add_test(NAME scripts_download_ycb_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/download_ycb_test.py ${PROJECT_SOURCE_DIR})
add_test(NAME scripts_plots_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/plots_test.py ${PROJECT_SOURCE_DIR})
set_tests_properties(scripts_plots_test PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME scripts_isolated_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/isolated_test.py
                 ${PROJECT_SOURCE_DIR} $<TARGET_FILE:simulator_node>)
set_tests_properties(scripts_isolated_test PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME scripts_installed_package_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/installed_package_test.py
                 ${PROJECT_SOURCE_DIR} ${CMAKE_BINARY_DIR})
add_test(NAME scripts_test_platform_test
         COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/scripts/test_platform_test.py ${PROJECT_SOURCE_DIR})
