target_sources(fvd_sim PRIVATE
  camera_registers.cpp
  genicam_xml.cpp
  gige_camera_server.cpp
  gvsp_sender.cpp
)
