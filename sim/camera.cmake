target_sources(fvd_sim PRIVATE
  camera_fault_script.cpp
  camera_registers.cpp
  frame_watermark.cpp
  genicam_xml.cpp
  gige_camera_server.cpp
  gige_control.cpp
  gige_streamer.cpp
  gvsp.cpp
  gvsp_sender.cpp
  sensor_readout.cpp
)
