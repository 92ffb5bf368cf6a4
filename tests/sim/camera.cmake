fvd_add_test(sim_camera_test LABELS sim LIBRARIES fvd::sim SOURCES gige_camera_server_test.cpp)
