fvd_add_test(sim_stage_test LABELS unit LIBRARIES fvd::sim SOURCES axis_model_test.cpp)
