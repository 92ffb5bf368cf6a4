#include "drivers/replay/slice_heights.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "core/base/error.hpp"
#include "drivers/replay/z_list.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::kBadInput, message); }

std::string_view unit_name(LengthUnit unit) {
  return unit == LengthUnit::kMicrometre ? "um" : unit == LengthUnit::kMillimetre ? "mm" : "m";
}

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

/// No stage makes such steps: they are numbers of another unit.
constexpr double kMinStep_um = 1e-3;

void check_unit(const ZSource& source, const std::vector<double>& z_um, const SliceList& list) {
  if (z_um.size() < 2) return;
  const double step_um = std::abs(z_um.back() - z_um.front()) / static_cast<double>(z_um.size() - 1);
  if (step_um >= kMinStep_um) return;
  std::ostringstream message;
  if (const auto* file = std::get_if<ZFile>(&source)) {
    message << file->path.string() << ": the mean step is " << step_um << " um, less than any stage makes; numbers in "
            << "another unit than um need it said: --z-unit mm or m of fvdctl process with --z-file, "
            << "stage.replay_z_unit of a configuration";
  } else {
    message << "a z step of " << step_um << " um"
            << (std::holds_alternative<ZNames>(source) ? " by " + list.z_from : std::string())
            << " is less than any stage makes; expected at least " << kMinStep_um << " um: give it in um, with "
            << "--z-step-um of fvdctl process";
  }
  refuse(message.str());
}

/// Whether slice i goes the way that the first two go.
bool goes_on(const std::vector<double>& z_um, std::size_t i) {
  return z_um[1] > z_um[0] ? z_um[i] > z_um[i - 1] : z_um[i] < z_um[i - 1];
}

void check_monotonic(const std::vector<double>& z_um, const SliceList& list) {
  for (std::size_t i = 1; i < z_um.size(); ++i) {
    if (goes_on(z_um, i)) continue;
    std::ostringstream message;
    message << "z of the slices must rise or fall all the way: slice " << i - 1 << " (" << list.slices[i - 1].name()
            << ") is at " << z_um[i - 1] << " um, slice " << i << " (" << list.slices[i].name() << ") at " << z_um[i]
            << " um; a list must be in the order of the slices, which is " << list.slices.front().name() << ", "
            << list.slices[1].name() << " to " << list.slices.back().name();
    refuse(message.str());
  }
}

/// A list that goes the other way than z in the names belongs to another order of the images.
void check_against_names(const ZFile& file, const std::vector<double>& z_um, const SliceList& list) {
  if (list.z_um.size() != z_um.size() || z_um.size() < 2) return;
  for (std::size_t i = 1; i < z_um.size(); ++i) {
    if ((z_um[i] > z_um[i - 1]) == (list.z_um[i] > list.z_um[i - 1])) continue;
    std::ostringstream message;
    message << file.path.string() << " is in another order than the slices: it puts " << list.slices[i - 1].name()
            << " at " << z_um[i - 1] << " um and " << list.slices[i].name() << " at " << z_um[i]
            << " um, their names say " << list.z_um[i - 1] << " um and " << list.z_um[i]
            << " um; sort it, or leave --z-file out to take z from the names";
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
    z_um = read_z_list(file->path, unit_name(file->unit));
    for (double& z : z_um) z = to_um(z, file->unit);
    if (z_um.size() != list.slices.size()) {
      refuse(file->path.string() + " has " + std::to_string(z_um.size()) + " heights, but there are " +
             std::to_string(list.slices.size()) + " slices: " + list.description);
    }
    check_unit(source, z_um, list);
    check_against_names(*file, z_um, list);
  } else if (std::holds_alternative<ZNames>(source)) {
    if (list.z_um.empty()) {
      refuse("the names of the slices " + list.description + " carry no z with a unit, such as z_0.5um: give a step, " +
             "a file with the z of each slice, or --pattern of fvdctl with {z_um} or {z_mm}");
    }
    z_um = list.z_um;
    check_unit(source, z_um, list);
  } else {
    if (!list.gap.empty()) {
      refuse("the slices " + list.description + " are not evenly numbered (" + list.gap +
             "), so their z cannot come from a constant step: give a file with the z of each slice, --z-file of fvdctl "
             "process, replay_z_file of a configuration");
    }
    z_um = spaced(std::get<ZSpacing>(source), list.slices.size());
    check_unit(source, z_um, list);
  }
  check_monotonic(z_um, list);
  return z_um;
}

int nearest_slice(const std::vector<double>& heights_um, double z_um) {
  const auto closest = std::min_element(heights_um.begin(), heights_um.end(),
                                        [z_um](double a, double b) { return std::abs(a - z_um) < std::abs(b - z_um); });
  return static_cast<int>(closest - heights_um.begin());
}

}  // namespace fvd
