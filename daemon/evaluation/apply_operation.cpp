#include "daemon/evaluation/apply_operation.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include "core/metrology/operations/form.hpp"
#include "core/metrology/operations/level.hpp"
#include "core/metrology/operations/masking.hpp"
#include "core/metrology/operations/outliers.hpp"
#include "core/metrology/operations/rearrange.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/operations/region_combine.hpp"
#include "daemon/evaluation/calibration_operation.hpp"
#include "daemon/evaluation/filter_operation.hpp"
#include "daemon/evaluation/plan_regions.hpp"
#include "daemon/evaluation/reason_names.hpp"

namespace fvd {

namespace {

using metrology::FormKind;
using metrology::HeightField;
using metrology::LevelMethod;
using metrology::OperationReport;
using metrology::Region;

/// The points that a fit is made to: those of any of the regions; every point where none is named.
Region fitted_points(const EvaluationPlan& plan, const PlannedOperation& step, const HeightField& field) {
  Region points;
  for (std::size_t i = 0; i < step.regions.size(); ++i) {
    Region next = region_points(plan, step.regions[i], field);
    points = i == 0 ? std::move(next) : metrology::region_union(points, next);
  }
  return points;
}

OperationReport level(const EvaluationPlan& plan, const PlannedOperation& step, WorkerPool* pool, HeightField& field) {
  LevelMethod method = LevelMethod::kLeastSquares;
  if (step.fit == "weighted") method = LevelMethod::kWeighted;
  if (step.fit == "robust") method = LevelMethod::kRobust;
  return metrology::level(field, method, fitted_points(plan, step, field), pool);
}

OperationReport form(const EvaluationPlan& plan, const PlannedOperation& step, HeightField& field) {
  constexpr std::array<std::pair<std::string_view, FormKind>, 5> kKinds{{{"plane", FormKind::kPlane},
                                                                         {"polynomial", FormKind::kPolynomial},
                                                                         {"sphere", FormKind::kSphere},
                                                                         {"cylinder", FormKind::kCylinder},
                                                                         {"cone", FormKind::kCone}}};
  metrology::FormSettings settings;
  settings.degree = step.degree;
  for (const auto& [name, kind] : kKinds) {
    if (name == step.form) settings.kind = kind;
  }
  return metrology::remove_form(field, settings, fitted_points(plan, step, field));
}

/// Coordinates stay as they are, so that regions mean the same points on every surface.
OperationReport keep_rectangle(const PlannedOperation& step, HeightField& field) {
  const PlannedRectangle& r = step.rectangle;
  const Region kept = metrology::rectangle_region(metrology::grid_of(field), {r.x_um, r.y_um, r.width_um, r.height_um});
  if (metrology::count_points(kept) == 0) return metrology::refusal("no point of the surface lies in the rectangle");
  OperationReport report;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (kept.at(x, y) != 0 || field.is_hole(x, y)) continue;
      metrology::make_hole(field, x, y, nullptr, 0);
      ++report.points_removed;
    }
  }
  return report;
}

}  // namespace

OperationReport apply_operation(const EvaluationPlan& plan, const PlannedOperation& step,
                                const EvaluationContext& context, WorkerPool* pool, Plane<MaskReasons>* reasons,
                                HeightField& field) {
  if (step.op == "lateral") return lateral_operation(context, reasons, field);
  if (step.op == "flatness_reference") return flatness_operation(context, reasons, field);
  if (step.op == "mask_reasons") {
    if (reasons == nullptr) return metrology::refusal("the surface does not tell why its points are holes (mask.png)");
    return metrology::mask_reasons(field, *reasons, reason_bits(step.reasons));
  }
  if (step.op == "mask_sigma") return metrology::mask_sigma(field, step.max_sigma_um, reasons, pool);
  if (step.op == "outliers") {
    return metrology::remove_outliers(field, {step.window_px, step.limit}, reasons, pool);
  }
  if (step.op == "level") return level(plan, step, pool, field);
  if (step.op == "form") return form(plan, step, field);
  if (step.op == "filter") return filter_operation(step, pool, field);
  if (step.op == "crop") return keep_rectangle(step, field);
  if (step.op == "shift_z") return metrology::shift_z(field, step.by_um);
  return metrology::invert(field);
}

}  // namespace fvd
