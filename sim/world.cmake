target_sources(fvd_sim PRIVATE
  line_trigger.cpp
  defocus_renderer.cpp
  gaussian_transfer.cpp
  gsf_reader.cpp
  sim_world.cpp
  surface.cpp
  texture.cpp
  world_config.cpp
)
set_source_files_properties(defocus_renderer.cpp PROPERTIES COMPILE_OPTIONS -O3)
target_link_libraries(fvd_sim PRIVATE fvd::config opencv_core opencv_imgproc opencv_imgcodecs)
target_sources(fvd_sim PRIVATE evaluate.cpp plant.cpp)

add_executable(fvd-sim fvd_sim_main.cpp)
target_link_libraries(fvd-sim PRIVATE fvd::sim CLI11::CLI11)
