#include "daemon/export/gsf.hpp"

#include <bit>

#include "daemon/export/export_input.hpp"
#include "daemon/export/length_text.hpp"
#include "daemon/export/surface_view.hpp"

namespace fvd {

namespace {

static_assert(std::endian::native == std::endian::little, "pixels are copied as they lie in memory");

/// Everything before the pixels.
std::string head_of(int width, int height, const GsfHeader& header) {
  const bool metric = header.pitch_x_um && header.pitch_y_um;
  std::string file = "Gwyddion Simple Field 1.0\n";
  const auto line = [&file](const std::string& key, const std::string& value) {
    file += one_line(key) + " = " + one_line(value) + "\n";
  };
  line("XRes", std::to_string(width));
  line("YRes", std::to_string(height));
  line("XReal", metric ? metres_text(*header.pitch_x_um, width) : std::to_string(width));
  line("YReal", metric ? metres_text(*header.pitch_y_um, height) : std::to_string(height));
  line("XYUnits", metric ? "m" : "px");
  line("ZUnits", "m");
  line("Title", header.title);
  for (const auto& [key, value] : header.metadata) line(key, value);
  file.append(4 - file.size() % 4, '\0');
  return file;
}

std::string_view bytes_of(const float* pixels, std::size_t count) {
  return {reinterpret_cast<const char*>(pixels), count * sizeof(float)};
}

void write_field(const PlaneView<const float>& field, const SurfaceView& surface, const std::string& title,
                 const ByteSink& sink) {
  sink(head_of(field.width, field.height, {title, surface.pitch_x_um, surface.pitch_y_um, surface.origin.facts()}));
  for (int y = 0; y < field.height; ++y) sink(bytes_of(field.row(y), static_cast<std::size_t>(field.width)));
}

}  // namespace

std::string encode_gsf(const Plane<float>& height_m, const GsfHeader& header) {
  std::string file = head_of(height_m.width(), height_m.height(), header);
  file += bytes_of(height_m.pixels().data(), height_m.pixels().size());
  return file;
}

std::string gsf_file(const ExportInput& input) {
  const SurfaceView view = surface_view(input);
  return encode_gsf(input.map.height_m, {view.origin.title, view.pitch_x_um, view.pitch_y_um, view.origin.facts()});
}

std::string repeat_sd_gsf_file(const ExportInput& input) {
  const SurfaceView view = surface_view(input);
  const RepeatedScans& repeated = input.data.repeated.value();
  return encode_gsf(repeated.sd_m,
                    {view.origin.title + ": standard deviation of " + std::to_string(repeated.scans) + " scans",
                     view.pitch_x_um, view.pitch_y_um, view.origin.facts()});
}

void write_gsf(const SurfaceView& surface, const ByteSink& sink) {
  write_field(surface.height_m, surface, surface.origin.title, sink);
}

void write_sigma_gsf(const SurfaceView& surface, const ByteSink& sink) {
  write_field(surface.sigma_m, surface, surface.origin.title + ": standard error", sink);
}

}  // namespace fvd
