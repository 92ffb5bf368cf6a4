target_sources(fvd_sim PRIVATE
  axis_model.cpp
  axis_motion.cpp
  az_drive.cpp
  modbus_tcp_server.cpp
)
