target_sources(fvd_sim PRIVATE
  ar_drive.cpp
  axis_model.cpp
  axis_motion.cpp
  az_drive.cpp
  cia402_drive.cpp
  drive_kinds.cpp
  fault_config.cpp
  fault_script.cpp
  leadshine_drive.cpp
  modbus_responder.cpp
  modbus_rtu_server.cpp
  modbus_tcp_server.cpp
  register_image.cpp
  scl_drive.cpp
  scripted_responder.cpp
  sim_drive.cpp
)
