#include "daemon/export/gsf.hpp"

#include <bit>
#include <charconv>

#include "core/base/units.hpp"
#include "daemon/export/export_input.hpp"

namespace fvd {

namespace {

static_assert(std::endian::native == std::endian::little, "pixels are copied as they lie in memory");

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
  return {text, end};
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

GsfHeader gsf_header(const ResultData& data) {
  GsfHeader header{result_title(data), data.pixel_pitch_x_um, data.pixel_pitch_y_um, {}};
  const auto add = [&header](const char* key, const std::string& value) {
    if (!value.empty()) header.metadata.emplace_back(key, value);
  };
  add("PartId", data.part_id);
  add("JobId", data.job_id);
  add("Recipe", data.recipe_id);
  add("RecipeSha256", data.recipe_sha256);
  add("Peak", std::string(peak_method_name(data.peak)));
  add("Software", data.software_version);
  add("Source", data.source);
  add("Simulated", data.simulated ? "true" : "false");
  return header;
}

}  // namespace

std::string encode_gsf(const Plane<float>& height_m, const GsfHeader& header) {
  const bool metric = header.pitch_x_um && header.pitch_y_um;
  const double pitch_x = metric ? *header.pitch_x_um * kMetresPerMicrometer : 1.0;
  const double pitch_y = metric ? *header.pitch_y_um * kMetresPerMicrometer : 1.0;

  std::string file = "Gwyddion Simple Field 1.0\n";
  const auto line = [&file](const std::string& key, const std::string& value) {
    file += one_line(key) + " = " + one_line(value) + "\n";
  };
  line("XRes", std::to_string(height_m.width()));
  line("YRes", std::to_string(height_m.height()));
  line("XReal", number(height_m.width() * pitch_x));
  line("YReal", number(height_m.height() * pitch_y));
  line("XYUnits", metric ? "m" : "px");
  line("ZUnits", "m");
  line("Title", header.title);
  for (const auto& [key, value] : header.metadata) line(key, value);
  file.append(4 - file.size() % 4, '\0');

  const auto pixels = std::as_bytes(height_m.pixels());
  file.append(reinterpret_cast<const char*>(pixels.data()), pixels.size());
  return file;
}

std::string gsf_file(const ExportInput& input) { return encode_gsf(input.map.height_m, gsf_header(input.data)); }

}  // namespace fvd
