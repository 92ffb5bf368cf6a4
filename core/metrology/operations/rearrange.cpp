#include "core/metrology/operations/rearrange.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/metrology/operations/masking.hpp"

namespace fvd::metrology {
namespace {

template <typename T>
Plane<T> block_of(const Plane<T>& plane, const PixelBlock& block) {
  Plane<T> part = Plane<T>::unset(block.end_column - block.first_column, block.end_row - block.first_row);
  for (int row = 0; row < part.height(); ++row) {
    std::copy_n(plane.row(block.first_row + row) + block.first_column, part.width(), part.row(row));
  }
  return part;
}

bool same_pitch(double a_um, double b_um) { return std::abs(a_um - b_um) <= 1e-6 * b_um; }

}  // namespace

OperationReport crop(HeightField& field, const RectangleUm& rectangle, Plane<MaskReasons>* reasons) {
  const PixelBlock block = pixels_in(grid_of(field), rectangle);
  if (block.empty()) return refusal("no point of the surface lies in the rectangle to be kept");
  field.z_um = block_of(field.z_um, block);
  if (field.has_sigma()) field.sigma_um = block_of(field.sigma_um, block);
  if (reasons != nullptr) *reasons = block_of(*reasons, block);
  OperationReport report;
  report.values = {{"first_column", static_cast<double>(block.first_column), std::nullopt},
                   {"first_row", static_cast<double>(block.first_row), std::nullopt},
                   {"columns", static_cast<double>(field.width()), std::nullopt},
                   {"rows", static_cast<double>(field.height()), std::nullopt}};
  return report;
}

OperationReport shift_z(HeightField& field, double shift_um) {
  assert(std::isfinite(shift_um));
  for (double& z : field.z_um.pixels()) z += shift_um;
  OperationReport report;
  report.values = {{"shift_um", shift_um, std::nullopt}};
  return report;
}

OperationReport invert(HeightField& field) {
  for (double& z : field.z_um.pixels()) z = -z;
  return {};
}

OperationReport flatness_reference(HeightField& field, const HeightField& reference, Plane<MaskReasons>* reasons) {
  if (reference.width() != field.width() || reference.height() != field.height()) {
    return refusal("the flatness reference has another size than the surface");
  }
  if (!same_pitch(field.pitch_x_um, reference.pitch_x_um) || !same_pitch(field.pitch_y_um, reference.pitch_y_um)) {
    return refusal("the flatness reference has another pitch than the surface");
  }
  OperationReport report;
  const bool both = field.has_sigma() && reference.has_sigma();
  if (field.has_sigma() != reference.has_sigma()) {
    report.warnings.emplace_back(field.has_sigma()
                                     ? "the flatness reference has no standard errors; they are left out"
                                     : "the surface has no standard errors; those of the reference are lost");
  }
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (field.is_hole(column, row)) continue;
      if (reference.is_hole(column, row)) {
        make_hole(field, column, row, reasons, mask_reason::kMaxSigma);
        ++report.points_removed;
        continue;
      }
      ++report.points_used;
      field.z_um.at(column, row) -= reference.z_um.at(column, row);
      if (!both) continue;
      float& sigma = field.sigma_um.at(column, row);
      sigma = std::hypot(sigma, reference.sigma_um.at(column, row));
    }
  }
  return report;
}

}  // namespace fvd::metrology
