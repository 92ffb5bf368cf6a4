fvd_add_test(sim_stage_test LABELS unit LIBRARIES fvd::sim SOURCES
  ar_drive_test.cpp
  axis_model_test.cpp
  az_drive_test.cpp
  cia402_drive_test.cpp
  drive_kinds_test.cpp
  fault_script_test.cpp
  leadshine_drive_test.cpp
  modbus_responder_test.cpp
  scl_drive_test.cpp
)
fvd_add_test(sim_line_test LABELS sim LIBRARIES fvd::sim PkgConfig::MODBUS SOURCES
  libmodbus_test.cpp
  line_faults_test.cpp
  modbus_rtu_server_test.cpp
)
