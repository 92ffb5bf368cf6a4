#include "core/metrology/study/flatness_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/metrology/operations/level.hpp"
#include "core/metrology/study/scan_stack.hpp"

namespace fvd::metrology {
namespace {

/// Sz of the points of the region.
double height_range_um(const HeightField& field, const Region& region) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (field.is_hole(x, y) || !is_inside(region, x, y)) continue;
      lowest = std::min(lowest, field.z_um.at(x, y));
      highest = std::max(highest, field.z_um.at(x, y));
    }
  }
  return highest - lowest;
}

}  // namespace

StudyOutcome<FlatnessStudy> flatness_deviation(std::span<const HeightField* const> maps, const Region& region) {
  StudyOutcome<ScanStack> stacked = stack_scans(maps, region, 1);
  if (StudyRefusal* refusal = std::get_if<StudyRefusal>(&stacked)) return std::move(*refusal);
  ScanStack& stack = std::get<ScanStack>(stacked);
  const HeightField& first = *maps.front();
  const auto n = static_cast<double>(maps.size());

  FlatnessStudy study;
  study.positions = static_cast<int>(maps.size());
  study.points = stack.points;
  study.valid_fraction = stack.valid_fraction;
  // All planes rest on the same points, so that the mean less its plane is the mean of the maps less theirs.
  study.reference = {std::move(stack.mean_um), {}, first.pitch_x_um, first.pitch_y_um, first.kernel};
  const OperationReport levelled = level(study.reference, LevelMethod::kLeastSquares, region);
  if (levelled.refused) return StudyRefusal{*levelled.refused};
  study.flatness_um = height_range_um(study.reference, region);
  if (maps.size() > 1) {
    study.reference.sigma_um = Plane<float>(first.width(), first.height());
    for (std::size_t i = 0; i < stack.squares_um2.pixels().size(); ++i) {
      study.reference.sigma_um.pixels()[i] =
          static_cast<float>(std::sqrt(stack.squares_um2.pixels()[i] / ((n - 1.0) * n)));
    }
  }
  return study;
}

}  // namespace fvd::metrology
