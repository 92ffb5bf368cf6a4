target_sources(fvd_sim PRIVATE
  axis_model.cpp
  axis_motion.cpp
  az_drive.cpp
  fault_script.cpp
  modbus_responder.cpp
  modbus_rtu_server.cpp
  modbus_tcp_server.cpp
  scripted_responder.cpp
)
