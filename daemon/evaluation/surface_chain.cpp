#include "daemon/evaluation/surface_chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/field_writer.hpp"
#include "core/base/error.hpp"
#include "core/base/units.hpp"
#include "core/metrology/operations/bands.hpp"
#include "daemon/evaluation/apply_operation.hpp"
#include "daemon/evaluation/calibration_operation.hpp"
#include "daemon/evaluation/evaluation_fields.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json report_json(const metrology::OperationReport& report) {
  ordered_json json{{"points_used", report.points_used}, {"points_removed", report.points_removed}};
  for (const metrology::NamedValue& value : report.values) {
    ordered_json one{{"value", value.value}};
    if (value.standard_error) one["standard_error"] = *value.standard_error;
    json["values"][value.name] = std::move(one);
  }
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  return json;
}

void note_filter(const PlannedOperation& step, SurfaceState& state) {
  if (step.side == "S") {
    state.s_nesting_um = std::max(state.s_nesting_um.value_or(0.0), step.nesting_um);
  } else {
    state.l_nesting_um =
        std::min(state.l_nesting_um.value_or(std::numeric_limits<double>::infinity()), step.nesting_um);
  }
}

float in_um(float metres) { return static_cast<float>(static_cast<double>(metres) / kMetresPerMicrometer); }

/// The rows from first to end in um, with holes for what files may have and a field must not: heights that are no
/// number, and heights whose standard error is none. The latter could not be weighed.
void take_rows(const SurfaceRef& surface, int first, int end, metrology::HeightField& field) {
  constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
  const int width = field.width();
  for (int row = first; row < end; ++row) {
    const float* height_m = surface.height_m.row(row);
    double* z_um = field.z_um.row(row);
    if (!surface.has_sigma()) {
      for (int x = 0; x < width; ++x) {
        const double um = static_cast<double>(height_m[x]) / kMetresPerMicrometer;
        z_um[x] = std::isfinite(um) ? um : kHole;
      }
      continue;
    }
    const float* sigma_m = surface.sigma_m.row(row);
    float* sigma_um = field.sigma_um.row(row);
    for (int x = 0; x < width; ++x) {
      const double um = static_cast<double>(height_m[x]) / kMetresPerMicrometer;
      const float error_um = in_um(sigma_m[x]);
      const bool usable = std::isfinite(um) && std::isfinite(error_um) && error_um >= 0.0F;
      z_um[x] = usable ? um : kHole;
      sigma_um[x] = usable ? error_um : std::numeric_limits<float>::quiet_NaN();
    }
  }
}

template <typename T>
Plane<T> copy_of(const Plane<T>& plane, const EvaluationMeans& means) {
  if (plane.empty()) return {};
  Plane<T> copy = Plane<T>::unset(plane.width(), plane.height(), means.pages);
  metrology::run_bands(means.pool, plane.height(), [&](int, int first, int end) {
    std::copy(plane.row(first), plane.row(first) + static_cast<std::ptrdiff_t>(end - first) * plane.width(),
              copy.row(first));
  });
  return copy;
}

metrology::HeightField copy_of(const metrology::HeightField& field, const EvaluationMeans& means) {
  return {copy_of(field.z_um, means), copy_of(field.sigma_um, means), field.pitch_x_um, field.pitch_y_um, field.kernel};
}

Plane<MaskReasons> copy_of(const PlaneView<const MaskReasons>& mask) {
  Plane<MaskReasons> copy = Plane<MaskReasons>::unset(mask.width, mask.height);
  for (int row = 0; row < mask.height; ++row) std::copy_n(mask.row(row), mask.width, copy.row(row));
  return copy;
}

bool asks_for_reasons(const EvaluationPlan& plan) {
  const auto asks = [](const PlannedOperation& step) { return step.op == "mask_reasons"; };
  return std::any_of(plan.surfaces.begin(), plan.surfaces.end(), [&asks](const auto& surface) {
    return std::any_of(surface.second.steps.begin(), surface.second.steps.end(), asks);
  });
}

bool looks_at_sigma(const PlannedOperation& step, const metrology::HeightField& field) {
  return step.op == "mask_sigma" || (step.op == "outliers" && field.has_sigma()) || step.fit == "weighted";
}

/// Masks that do not fit the surface are data too: a refusal.
metrology::OperationReport applied(const EvaluationPlan& plan, const PlannedOperation& step,
                                   const EvaluationContext& context, WorkerPool* pool, Plane<MaskReasons>* reasons,
                                   metrology::HeightField& field) {
  try {
    return apply_operation(plan, step, context, pool, reasons, field);
  } catch (const Error& error) {
    return metrology::refusal(error.what());
  }
}

}  // namespace

SurfaceChain::SurfaceChain(SurfaceRef surface, const EvaluationPlan& plan, const EvaluationContext& context,
                           WorkerPool* pool, KeptPagesPtr pages)
    : surface_(std::move(surface)), plan_(plan), context_(context), means_{pool, std::move(pages)} {}

const SurfaceState& SurfaceChain::state(const std::string& name) {
  if (const auto found = states_.find(name); found != states_.end()) return found->second;
  SurfaceState state = name == kMeasuredSurface ? measured() : made(plan_.surfaces.at(name));
  return states_.emplace(name, std::move(state)).first->second;
}

SurfaceState SurfaceChain::measured() const {
  SurfaceState state;
  metrology::HeightField& field = state.field;
  const int width = surface_.height_m.width;
  const int height = surface_.height_m.height;
  field.z_um = Plane<double>::unset(width, height, means_.pages);
  if (surface_.has_sigma()) field.sigma_um = Plane<float>::unset(width, height, means_.pages);
  metrology::run_bands(means_.pool, height, [&](int, int first, int end) { take_rows(surface_, first, end, field); });
  field.pitch_x_um = surface_.pitch_x_um;
  field.pitch_y_um = surface_.pitch_y_um;
  field.kernel = surface_.kernel;
  state.steps_json = "[]";
  if (context_.calibration && context_.calibration->z) {
    state.z_scale = z_amplification(context_);
    divide_heights(state.z_scale, field);
    const ordered_json step{
        {"op", "calibration"}, {"alpha_z", state.z_scale}, {"calibration", context_.calibration->id}};
    state.steps_json = ordered_json::array({step}).dump();
  }
  if (surface_.has_mask() && asks_for_reasons(plan_)) state.reasons = copy_of(surface_.mask);
  if (field.has_sigma() && !knows_window(field)) {
    state.warnings.push_back({"window_unknown",
                              "the focus window of the surface is not known: its points' errors are taken to be "
                              "independent, and where they are not U is too small, by the window's width in points"});
  }
  return state;
}

SurfaceState SurfaceChain::made(const PlannedSurface& planned) {
  const SurfaceState& source = state(planned.from);
  SurfaceState made;
  made.refused = source.refused;
  made.refused_code = source.refused_code;
  made.steps_json = source.steps_json;  // of which the last says why
  if (!made.refused.empty()) return made;
  made.field = copy_of(source.field, means_);
  made.z_scale = source.z_scale;
  made.reasons = source.reasons.clone();
  made.reference_subtracted = source.reference_subtracted;
  made.s_nesting_um = source.s_nesting_um;
  made.l_nesting_um = source.l_nesting_um;
  made.uses_sigma = source.uses_sigma;
  made.levelled = source.levelled;
  made.removed_slope_x = source.removed_slope_x;
  made.removed_slope_y = source.removed_slope_y;
  made.robust = source.robust;
  made.warnings = source.warnings;
  ordered_json steps = ordered_json::parse(source.steps_json);
  for (PlannedOperation step : planned.steps) {
    ordered_json json = fields_to_json([&](Fields& fields) { describe(step, fields); });
    const std::string missing = missing_calibration(step, context_);
    Plane<MaskReasons>* const reasons = made.reasons.empty() ? nullptr : &made.reasons;
    const metrology::OperationReport report = missing.empty()
                                                  ? applied(plan_, step, context_, means_.pool, reasons, made.field)
                                                  : metrology::refusal(missing);
    if (report.refused) {
      if (!missing.empty()) made.refused_code = evaluation_code::kCalibrationMissing;
      made.refused = step.op + ": " + *report.refused;
      json["refused"] = *report.refused;
      steps.push_back(std::move(json));
      break;
    }
    if (step.op == "filter") note_filter(step, made);
    made.reference_subtracted = made.reference_subtracted || step.op == "flatness_reference";
    made.levelled = made.levelled || step.op == "level" || step.op == "form";
    made.robust = made.robust || step.op == "outliers" || step.robust;
    if (const auto* slope = report.find("slope_x")) made.removed_slope_x += slope->value;
    if (const auto* slope = report.find("slope_y")) made.removed_slope_y += slope->value;
    made.uses_sigma = made.uses_sigma || looks_at_sigma(step, made.field);
    for (const std::string& text : report.warnings) made.warnings.push_back({step.op, text});
    json["did"] = report_json(report);
    steps.push_back(std::move(json));
  }
  made.steps_json = steps.dump();
  return made;
}

}  // namespace fvd
