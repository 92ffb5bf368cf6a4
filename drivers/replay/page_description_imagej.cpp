#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>

#include "drivers/replay/page_description.hpp"

namespace fvd {

namespace {

std::optional<double> decimal(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

using Values = std::map<std::string, std::string, std::less<>>;

Values key_values(std::string_view text) {
  Values values;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    while (!line.empty() && (line.back() == '\r' || line.back() == '\0' || line.back() == ' ')) line.remove_suffix(1);
    const std::size_t equals = line.find('=');
    if (equals != std::string_view::npos) values.emplace(line.substr(0, equals), line.substr(equals + 1));
  }
  return values;
}

/// At least 1; 1 where the key is missing.
int count_of(const Values& values, std::string_view key) {
  const auto found = values.find(key);
  int count = 1;
  if (found != values.end()) {
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), count);
  }
  return std::max(count, 1);
}

std::optional<double> spacing_um(const Values& values) {
  const auto spacing = values.find("spacing");
  auto unit = values.find("zunit");
  if (unit == values.end()) unit = values.find("unit");
  if (spacing == values.end() || unit == values.end()) return std::nullopt;
  const auto value = decimal(spacing->second);
  const double size_um = described_unit_um(unit->second);
  if (!value || !std::isfinite(*value) || *value == 0.0 || size_um == 0.0) return std::nullopt;
  return *value * size_um;
}

}  // namespace

double described_unit_um(std::string_view unit) {
  std::string name;
  for (const char c : unit) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto is = [&name](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
  };
  if (is({"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m", "\\u00b5m", "\\u03bcm", "micron", "microns", "micrometer",
          "micrometre", "micrometers"})) {
    return 1.0;
  }
  if (is({"mm", "millimeter", "millimetre"})) return 1e3;
  if (is({"cm", "centimeter", "centimetre"})) return 1e4;
  if (is({"nm", "nanometer", "nanometre"})) return 1e-3;
  if (is({"m", "meter", "metre"})) return 1e6;
  if (is({"in", "inch", "inches"})) return 25'400.0;
  return 0.0;
}

std::optional<PageDescription> read_imagej_description(std::string_view text) {
  if (!text.starts_with("ImageJ=")) return std::nullopt;
  const Values values = key_values(text);
  const int images = count_of(values, "images");
  if (images < 2) return std::nullopt;
  PageDescription description;
  description.written_by = "ImageJ";
  description.channels = count_of(values, "channels");
  description.slices = count_of(values, "slices");
  description.times = count_of(values, "frames");
  description.spacing_um = spacing_um(values);
  if (std::max({images, description.channels, description.slices, description.times}) > kMaxPages) {
    description.problem = "it tells of more than a million images";
    return description;
  }
  const long long told = 1LL * description.channels * description.slices * description.times;
  if (told == 1) description.slices = images;
  if (told != 1 && told != images) {
    description.problem = "it tells of " + std::to_string(images) + " images, but of " +
                          std::to_string(description.channels) + " channels, " + std::to_string(description.slices) +
                          " slices and " + std::to_string(description.times) + " times";
    return description;
  }
  for (int page = 0; page < images; ++page) {
    const int z_and_time = page / description.channels;
    description.pages.push_back({page, z_and_time % description.slices, page % description.channels,
                                 z_and_time / description.slices, std::nullopt});
  }
  return description;
}

}  // namespace fvd
