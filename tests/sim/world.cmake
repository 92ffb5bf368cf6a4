fvd_add_test(sim_world_test LABELS sim
  LIBRARIES fvd::sim nlohmann_json::nlohmann_json opencv_core opencv_imgcodecs
  SOURCES evaluate_test.cpp renderer_test.cpp surface_test.cpp)
target_compile_definitions(sim_world_test PRIVATE FVD_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_test(NAME fvd_sim_test COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/fvd_sim_test.sh $<TARGET_FILE:fvd-sim>)
set_tests_properties(fvd_sim_test PROPERTIES LABELS sim TIMEOUT 120)
