#include "core/metrology/operations/masking.hpp"

#include <cassert>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/metrology/operations/bands.hpp"

namespace fvd::metrology {

void make_hole(HeightField& field, int column, int row, Plane<MaskReasons>* reasons, MaskReasons reason) {
  field.z_um.at(column, row) = std::numeric_limits<double>::quiet_NaN();
  if (field.has_sigma()) field.sigma_um.at(column, row) = std::numeric_limits<float>::quiet_NaN();
  if (reasons == nullptr) return;
  MaskReasons& bits = reasons->at(column, row);
  bits = static_cast<MaskReasons>(bits | reason);
}

OperationReport mask_sigma(HeightField& field, double max_sigma_um, Plane<MaskReasons>* reasons, WorkerPool* pool) {
  assert(max_sigma_um > 0.0);
  if (!field.has_sigma()) return refusal("the surface has no standard errors");
  struct Counts {
    std::size_t used = 0;
    std::size_t removed = 0;
  };
  std::vector<Counts> of_bands(static_cast<std::size_t>(band_count(field.height())));
  run_bands(pool, field.height(), [&](int band, int first, int end) {
    Counts& counts = of_bands[static_cast<std::size_t>(band)];
    for (int row = first; row < end; ++row) {
      const double* z = field.z_um.row(row);
      const float* sigma_um = field.sigma_um.row(row);
      for (int column = 0; column < field.width(); ++column) {
        if (z[column] != z[column]) continue;
        ++counts.used;
        if (static_cast<double>(sigma_um[column]) <= max_sigma_um) continue;
        make_hole(field, column, row, reasons, mask_reason::kMaxSigma);
        ++counts.removed;
      }
    }
  });
  OperationReport report;
  report.values = {{"max_sigma_um", max_sigma_um, std::nullopt}};
  for (const Counts& counts : of_bands) {
    report.points_used += counts.used;
    report.points_removed += counts.removed;
  }
  return report;
}

OperationReport mask_reasons(HeightField& field, const Plane<MaskReasons>& reasons, MaskReasons bits) {
  if (reasons.width() != field.width() || reasons.height() != field.height()) {
    return refusal("the reasons of the points have another size than the surface");
  }
  OperationReport report;
  report.values = {{"reason_bits", static_cast<double>(bits), std::nullopt}};
  for (int row = 0; row < field.height(); ++row) {
    for (int column = 0; column < field.width(); ++column) {
      if (field.is_hole(column, row)) continue;
      ++report.points_used;
      if ((reasons.at(column, row) & bits) == 0) continue;
      make_hole(field, column, row, nullptr, 0);
      ++report.points_removed;
    }
  }
  return report;
}

}  // namespace fvd::metrology
