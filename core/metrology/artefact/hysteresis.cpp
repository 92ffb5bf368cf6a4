#include "core/metrology/artefact/hysteresis.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.hpp"
#include "core/metrology/operations/level.hpp"

namespace fvd::metrology {
namespace {

constexpr int kFewestPoints = 100;

void check(const HeightField& up, const HeightField& down, const Region& region) {
  const bool same = up.width() == down.width() && up.height() == down.height() && up.pitch_x_um == down.pitch_x_um &&
                    up.pitch_y_um == down.pitch_y_um;
  if (!same) throw Error(ErrorCode::kBadInput, "the scans of a hysteresis differ in size or pitch");
  if (!region.empty() && (region.width() != up.width() || region.height() != up.height())) {
    throw Error(ErrorCode::kBadInput, "the region has another size than the scans");
  }
}

/// Holes outside of the region too. Standard errors are left out: the rest's scatter is what counts.
HeightField difference(const HeightField& up, const HeightField& down, const Region& region) {
  HeightField field{Plane<double>(up.width(), up.height()), {}, up.pitch_x_um, up.pitch_y_um, up.kernel};
  for (int y = 0; y < up.height(); ++y) {
    for (int x = 0; x < up.width(); ++x) {
      field.z_um.at(x, y) =
          is_inside(region, x, y) ? down.z_um.at(x, y) - up.z_um.at(x, y) : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return field;
}

struct Sum {
  double sum = 0.0;
  double squares = 0.0;
  int points = 0;
};

Sum sum_of(const HeightField& field) {
  Sum sum;
  for (const double z : field.z_um.pixels()) {
    if (std::isnan(z)) continue;
    sum.sum += z;
    sum.squares += z * z;
    ++sum.points;
  }
  return sum;
}

int points_inside(const HeightField& field, const Region& region) {
  int points = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) points += is_inside(region, x, y) ? 1 : 0;
  }
  return points;
}

}  // namespace

StudyOutcome<Hysteresis> hysteresis(const HeightField& up, const HeightField& down, const Region& region) {
  check(up, down, region);
  HeightField field = difference(up, down, region);
  const Sum before = sum_of(field);
  if (before.points < kFewestPoints) {
    return StudyRefusal{std::to_string(before.points) + " points are valid in both scans, at least " +
                        std::to_string(kFewestPoints) + " are needed"};
  }
  const OperationReport plane = level(field, LevelMethod::kLeastSquares, {});
  if (plane.refused) return StudyRefusal{"the scans' common points have no plane: " + *plane.refused};
  const Sum rest = sum_of(field);

  Hysteresis result;
  const double points = before.points;
  result.points = before.points;
  result.valid_fraction = points / points_inside(field, region);
  result.mean_um = before.sum / points;
  result.slope_x = plane.find("slope_x")->value;
  result.slope_y = plane.find("slope_y")->value;
  result.rest_um = std::sqrt(rest.squares / points);
  // Neighbours share their errors over an area of the kernel's width squared.
  result.u_mean_um = result.rest_um * field.kernel.width_px() / std::sqrt(points);
  return result;
}

}  // namespace fvd::metrology
