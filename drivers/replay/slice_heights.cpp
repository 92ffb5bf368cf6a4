#include "drivers/replay/slice_heights.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "core/base/error.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

double to_um(double value, LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMicrometre:
      return value;
    case LengthUnit::kMillimetre:
      return value * 1e3;
    case LengthUnit::kMetre:
      return value * 1e6;
  }
  return value;
}

std::string_view trimmed(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const auto first = line.find_first_not_of(" \t\r\xEF\xBB\xBF");  // and a byte order mark
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

std::vector<double> read_file(const ZFile& file) {
  std::ifstream stream(file.path);
  if (!stream) refuse("cannot read the z file " + file.path.string());
  std::vector<double> z_um;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string_view text = trimmed(line);
    if (text.empty()) continue;
    const std::string where = file.path.string() + " line " + std::to_string(number) + ": '" + std::string(text) + "' ";
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      refuse(where + "is not one number with a decimal point");
    }
    if (!std::isfinite(value)) refuse(where + "is not a finite height");
    z_um.push_back(to_um(value, file.unit));
  }
  if (stream.bad()) refuse("reading the z file " + file.path.string() + " failed");
  return z_um;
}

/// No stage makes such steps: they are numbers of another unit.
constexpr double kMinFileStep_um = 1e-3;

void check_unit(const ZFile& file, const std::vector<double>& z_um) {
  if (z_um.size() < 2) return;
  const double step_um = std::abs(z_um.back() - z_um.front()) / static_cast<double>(z_um.size() - 1);
  if (step_um >= kMinFileStep_um) return;
  std::ostringstream message;
  message << file.path.string() << ": the mean step is " << step_um << " um, less than any stage makes; numbers in "
          << "another unit than um need it said: --z-unit mm or m of fvdctl process with --z-file, stage.replay_z_unit "
          << "of a configuration";
  refuse(message.str());
}

void check_monotonic(const std::vector<double>& z_um) {
  for (std::size_t i = 1; i < z_um.size(); ++i) {
    const bool rising = z_um[1] > z_um[0];
    if (rising ? z_um[i] > z_um[i - 1] : z_um[i] < z_um[i - 1]) continue;
    std::ostringstream message;
    message << "z of the slices must rise or fall all the way: slice " << i - 1 << " is at " << z_um[i - 1]
            << " um, slice " << i << " at " << z_um[i] << " um";
    refuse(message.str());
  }
}

std::vector<double> spaced(const ZSpacing& spacing, std::size_t slices) {
  if (!std::isfinite(spacing.start_um) || !std::isfinite(spacing.step_um) || spacing.step_um == 0.0) {
    std::ostringstream message;
    message << "a z step of " << spacing.step_um << " um from " << spacing.start_um
            << " um: both must be finite and the step not 0";
    refuse(message.str());
  }
  std::vector<double> z_um;
  for (std::size_t i = 0; i < slices; ++i) z_um.push_back(spacing.start_um + static_cast<double>(i) * spacing.step_um);
  return z_um;
}

}  // namespace

std::optional<LengthUnit> length_unit_from_name(std::string_view name) noexcept {
  if (name == "um") return LengthUnit::kMicrometre;
  if (name == "mm") return LengthUnit::kMillimetre;
  if (name == "m") return LengthUnit::kMetre;
  return std::nullopt;
}

std::vector<double> slice_heights_um(const ZSource& source, const SliceList& list) {
  std::vector<double> z_um;
  if (const auto* file = std::get_if<ZFile>(&source)) {
    z_um = read_file(*file);
    if (z_um.size() != list.slices.size()) {
      refuse(file->path.string() + " has " + std::to_string(z_um.size()) + " heights, but there are " +
             std::to_string(list.slices.size()) + " slices: " + list.description);
    }
    check_unit(*file, z_um);
  } else {
    if (!list.gap.empty()) {
      refuse("the slices " + list.description + " are not evenly numbered (" + list.gap +
             "), so their z cannot come from a constant step: give a file with the z of each slice, or number them "
             "without a gap");
    }
    z_um = spaced(std::get<ZSpacing>(source), list.slices.size());
  }
  check_monotonic(z_um);
  return z_um;
}

int nearest_slice(const std::vector<double>& heights_um, double z_um) {
  const auto closest = std::min_element(heights_um.begin(), heights_um.end(),
                                        [z_um](double a, double b) { return std::abs(a - z_um) < std::abs(b - z_um); });
  return static_cast<int>(closest - heights_um.begin());
}

}  // namespace fvd
