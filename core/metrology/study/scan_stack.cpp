#include "core/metrology/study/scan_stack.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/error.hpp"
#include "core/metrology/operations/level.hpp"

namespace fvd::metrology {
namespace {

bool same_pitch(double a, double b) { return std::abs(a - b) <= 1e-9 * b; }

void check(std::span<const HeightField* const> scans, const Region& region, int least_scans) {
  const auto n = static_cast<int>(scans.size());
  if (n < least_scans || n > kMostScans) {
    throw Error(ErrorCode::kBadInput, "a study takes " + std::to_string(least_scans) + " to " +
                                          std::to_string(kMostScans) + " scans, not " + std::to_string(n));
  }
  const HeightField& first = *scans.front();
  for (const HeightField* scan : scans) {
    const bool same = scan->width() == first.width() && scan->height() == first.height() &&
                      same_pitch(scan->pitch_x_um, first.pitch_x_um) && same_pitch(scan->pitch_y_um, first.pitch_y_um);
    if (!same) throw Error(ErrorCode::kBadInput, "the scans of a study differ in size or pitch");
  }
  if (!region.empty() && (region.width() != first.width() || region.height() != first.height())) {
    throw Error(ErrorCode::kBadInput, "the region of a study has another size than the scans");
  }
}

/// NaN where one of them is.
Plane<double> mean_of(std::span<const HeightField* const> scans) {
  Plane<double> mean(scans.front()->width(), scans.front()->height());
  for (const HeightField* scan : scans) {
    for (std::size_t i = 0; i < mean.pixels().size(); ++i) mean.pixels()[i] += scan->z_um.pixels()[i];
  }
  for (double& value : mean.pixels()) value /= static_cast<double>(scans.size());
  return mean;
}

void count_points(ScanStack& stack, const Region& region) {
  int asked = 0;
  for (int y = 0; y < stack.mean_um.height(); ++y) {
    for (int x = 0; x < stack.mean_um.width(); ++x) {
      if (!is_inside(region, x, y)) continue;
      ++asked;
      if (!std::isnan(stack.mean_um.at(x, y))) ++stack.points;
    }
  }
  stack.valid_fraction = asked > 0 ? static_cast<double>(stack.points) / asked : 0.0;
}

}  // namespace

StudyOutcome<ScanStack> stack_scans(std::span<const HeightField* const> scans, const Region& region, int least_scans) {
  check(scans, region, least_scans);
  const HeightField& first = *scans.front();
  ScanStack stack;
  stack.mean_um = mean_of(scans);
  count_points(stack, region);
  if (stack.points < kFewestPoints) {
    return StudyRefusal{"only " + std::to_string(stack.points) + " points are valid in all of " +
                        std::to_string(scans.size()) + " scans, " + std::to_string(kFewestPoints) + " are needed"};
  }
  stack.squares_um2 = Plane<double>(first.width(), first.height());
  HeightField deviation{Plane<double>(first.width(), first.height()), {}, first.pitch_x_um, first.pitch_y_um, {}};
  for (const HeightField* scan : scans) {
    for (std::size_t i = 0; i < stack.mean_um.pixels().size(); ++i) {
      deviation.z_um.pixels()[i] = scan->z_um.pixels()[i] - stack.mean_um.pixels()[i];
    }
    const OperationReport levelled = level(deviation, LevelMethod::kLeastSquares, region);
    if (levelled.refused) return StudyRefusal{*levelled.refused};
    for (std::size_t i = 0; i < stack.mean_um.pixels().size(); ++i) {
      stack.squares_um2.pixels()[i] += deviation.z_um.pixels()[i] * deviation.z_um.pixels()[i];
    }
  }
  return stack;
}

}  // namespace fvd::metrology
