/// Writes heights as rows of numbers.

#include <array>
#include <charconv>
#include <cmath>

#include "daemon/export/binary_text.hpp"
#include "daemon/export/surface_writers.hpp"

namespace fvd {

namespace {

constexpr int kMicrometreExponent = 6;

/// The shortest digits that mean this float in metres, with the point moved to um: read with "e-6" behind them they are
/// that float again.
std::string_view um_text(float metres, std::array<char, 96>& text) {
  if (std::isnan(metres)) return "nan";
  std::array<char, 32> scientific{};
  char* const end =
      std::to_chars(scientific.data(), scientific.data() + scientific.size(), metres, std::chars_format::scientific)
          .ptr;
  std::array<char, 32> digits{};
  int count = 0;
  const char* at = scientific.data();
  char* to = text.data();
  if (*at == '-') *to++ = *at++;
  for (; *at != 'e'; ++at) {
    if (*at != '.') digits[static_cast<std::size_t>(count++)] = *at;
  }
  ++at;
  if (*at == '+') ++at;
  int exponent = 0;
  std::from_chars(at, end, exponent);
  const int whole = exponent + kMicrometreExponent + 1;  // digits before the point
  if (whole <= 0) *to++ = '0';
  for (int i = 0; i < whole; ++i) *to++ = i < count ? digits[static_cast<std::size_t>(i)] : '0';
  if (whole < count && !(count == 1 && digits[0] == '0')) {
    *to++ = '.';
    for (int i = whole; i < count; ++i) *to++ = i < 0 ? '0' : digits[static_cast<std::size_t>(i)];
  }
  return {text.data(), static_cast<std::size_t>(to - text.data())};
}

std::string number(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string header_of(const SurfaceView& surface) {
  std::string text = "# fvd surface: heights, first row on top, first column left, nan = hole\n";
  const auto line = [&text](const std::string& key, const std::string& value) {
    text += "# " + key + " = " + one_line(value) + "\n";
  };
  if (!surface.origin.title.empty()) line("title", surface.origin.title);
  line("unit", "um");
  line("pitch_x_um", number(surface.pitch_x_um.value()));
  line("pitch_y_um", number(surface.pitch_y_um.value()));
  line("columns", std::to_string(surface.height_m.width));
  line("rows", std::to_string(surface.height_m.height));
  for (const auto& [key, value] : surface.origin.facts()) line(key, value);
  return text;
}

}  // namespace

void write_csv(const SurfaceView& surface, const ByteSink& sink) {
  BinaryText file(sink);
  file.add_text(header_of(surface));
  std::array<char, 96> text{};
  for (int y = 0; y < surface.height_m.height; ++y) {
    const float* const row = surface.height_m.row(y);
    for (int x = 0; x < surface.height_m.width; ++x) {
      if (x > 0) file.add_text(",");
      file.add_text(um_text(row[x], text));
    }
    file.add_text("\n");
  }
  file.flush();
}

}  // namespace fvd
