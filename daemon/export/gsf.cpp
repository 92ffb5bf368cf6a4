#include "daemon/export/gsf.hpp"

#include <bit>
#include <charconv>

#include "core/base/units.hpp"

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

}  // namespace fvd
