fvd_add_test(sim_stage_test LABELS unit LIBRARIES fvd::sim SOURCES
  axis_model_test.cpp
  modbus_responder_test.cpp
)
fvd_add_test(sim_line_test LABELS sim LIBRARIES fvd::sim SOURCES
  modbus_rtu_server_test.cpp
)
