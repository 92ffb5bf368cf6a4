#include "daemon/study/study_jobs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.hpp"
#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "daemon/evaluation/surface_chain.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/pipeline/evaluation_input.hpp"
#include "daemon/study/study_draft.hpp"
#include "daemon/surface_files/result_folder.hpp"

namespace fvd {

namespace {

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::kStudyRefused, why); }

std::string shape_text(const metrology::HeightField& field) {
  return std::to_string(field.width()) + " x " + std::to_string(field.height()) + " points at " +
         number_text(field.pitch_x_um) + " x " + number_text(field.pitch_y_um) + " um";
}

bool same_shape(const metrology::HeightField& a, const metrology::HeightField& b) {
  return a.width() == b.width() && a.height() == b.height() && a.pitch_x_um == b.pitch_x_um &&
         a.pitch_y_um == b.pitch_y_um;
}

std::string names_of(const auto& map) {
  std::string names;
  for (const auto& [name, unused] : map) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

/// Without what the constants bring: they are what is sought.
std::optional<double> u_of(const EvaluatedValue& value, Corrected corrected) {
  if (!value.u || corrected == Corrected::kAsMeasured || value.budget.empty()) return value.u;
  double squares = 0.0;
  for (const UncertaintyLine& line : value.budget) {
    if (line.source == "alpha_z" || line.source == "l_z") continue;
    squares += line.u * line.u;
  }
  return std::sqrt(squares);
}

/// The factor that undoes the correction of heights.
double undoing_factor(const Result& result, const std::string& calibration, const std::string& unit) {
  if (calibration == "none" || unit != "um") return 1.0;
  if (!result.calibration || result.calibration->id != calibration) {
    refuse("job " + result.job.id + ": its values were corrected by " + calibration +
           ", which its result does not tell; give a recipe, so that the surface is evaluated anew");
  }
  return result.calibration->z ? result.calibration->z->alpha_z : 1.0;
}

}  // namespace

StudyJobs::Job& StudyJobs::job(const std::string& id) {
  if (const auto found = jobs_.find(id); found != jobs_.end()) return found->second;
  if (stop_.stop_requested()) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down");
  const StoredJob stored = sources_.job(id);
  if (stored.result_dir.empty() || stored.result_json.empty()) {
    refuse("job " + id + " has no result: it " +
           (stored.status.state == JobState::kProcessing
                ? "has not ended"
                : "ended as " + std::string(job_state_name(stored.status.state)) + ", " + stored.status.error_message));
  }
  return jobs_.emplace(id, Job{stored.result_dir, read_result_json(stored.result_json), {}}).first->second;
}

const Result& StudyJobs::result(const std::string& id) { return job(id).result; }

metrology::HeightField StudyJobs::field(const std::string& id, std::optional<double> s_nesting_um) {
  const Job& found = job(id);
  ResultSurface read = read_result_surface(found.folder);
  note_window(read.result.focus, read.surface);
  EvaluationPlan plan;
  std::string name = kMeasuredSurface;
  if (s_nesting_um) {
    name = "filtered";
    plan.surfaces[name].steps.emplace_back();
    plan.surfaces[name].steps.back().op = "filter";
    plan.surfaces[name].steps.back().nesting_um = *s_nesting_um;
  }
  const EvaluationContext no_constants;  // as scanned: a study finds the constants
  SurfaceChain chain(read.surface, plan, no_constants, nullptr);
  const SurfaceState& state = chain.state(name);
  if (!state.refused.empty()) refuse("job " + id + ": " + state.refused);
  return state.field.clone();
}

void StudyJobs::check_memory(const std::vector<std::string>& jobs) {
  constexpr std::size_t kBytesKept = 12;       // of a point of each job: height and standard error
  constexpr std::size_t kBytesMeanwhile = 64;  // of a point of one job: its file, filter and the sums of all
  std::size_t most = 0;
  for (const std::string& id : jobs) {
    const Result::Focus& focus = result(id).focus;
    most = std::max(most, static_cast<std::size_t>(std::max(focus.width_px, 0)) *
                              static_cast<std::size_t>(std::max(focus.height_px, 0)));
  }
  const std::size_t needed = most * (kBytesKept * jobs.size() + kBytesMeanwhile);
  if (needed <= sources_.memory_budget_bytes) return;
  throw Error(ErrorCode::kMemoryBudget, "the study needs " + std::to_string(needed >> 20U) + " MiB of the " +
                                            std::to_string(sources_.memory_budget_bytes >> 20U) +
                                            " MiB of /compute/memory_budget_mib: give fewer jobs");
}

std::vector<metrology::HeightField> StudyJobs::fields(const std::vector<std::string>& jobs,
                                                      std::optional<double> s_nesting_um) {
  check_memory(jobs);
  std::vector<metrology::HeightField> fields;
  for (const std::string& id : jobs) {
    if (stop_.stop_requested()) throw Error(ErrorCode::kShuttingDown, "the daemon is shutting down");
    fields.push_back(field(id, s_nesting_um));
    if (!same_shape(fields.front(), fields.back())) {
      refuse("job " + id + " has " + shape_text(fields.back()) + ", job " + jobs.front() + " has " +
             shape_text(fields.front()) + ": scans of one study must have the same");
    }
  }
  return fields;
}

const Evaluation& StudyJobs::evaluation_of(const std::string& id, const std::string& recipe, Corrected corrected) {
  Job& found = job(id);
  if (recipe.empty()) {
    if (found.result.evaluation) return *found.result.evaluation;
    refuse("job " + id + " evaluated nothing: give a recipe that has measurements");
  }
  if (found.evaluation) return *found.evaluation;
  if (!recipe_) recipe_ = sources_.recipe(recipe);
  if (recipe_->evaluation.empty()) refuse("recipe " + recipe + " has no measurements");
  ResultSurface read = read_result_surface(found.folder);
  EvaluationContext context = read_evaluation_context(found.folder, read.result);
  note_window(read.result.focus, read.surface);
  context.calibration = found.result.calibration;
  if (corrected == Corrected::kUndone && context.calibration) context.calibration->z.reset();
  return found.evaluation.emplace(evaluate_surface(read.surface, recipe_->evaluation, context, nullptr));
}

JobValue StudyJobs::value(const std::string& id, const EvaluatedChoice& what, const std::string& recipe,
                          Corrected corrected) {
  const Evaluation& evaluation = evaluation_of(id, recipe, corrected);
  const auto measurement = evaluation.measurements.find(what.measurement);
  if (measurement == evaluation.measurements.end()) {
    refuse("job " + id + " has no measurement '" + what.measurement + "', but " + names_of(evaluation.measurements));
  }
  const EvaluatedMeasurement& measured = measurement->second;
  const std::string key = what.value.empty() ? measured.main_value : what.value;
  const std::string name = what.measurement + "." + key;
  if (!measured.reason.empty()) refuse("job " + id + ": " + what.measurement + " is invalid: " + measured.reason);
  const auto value = measured.values.find(key);
  if (value == measured.values.end()) {
    refuse("job " + id + ": " + what.measurement + " has no value '" + key + "', but " + names_of(measured.values));
  }
  const EvaluatedValue& found = value->second;
  if (!found.value || !std::isfinite(*found.value)) {
    refuse("job " + id + ": " + name + " has no number" + (found.reason.empty() ? "" : ": " + found.reason));
  }
  JobValue taken{name, found.unit, *found.value, u_of(found, corrected)};
  if (corrected == Corrected::kUndone && recipe.empty()) {
    const double factor = undoing_factor(result(id), evaluation.calibration, found.unit);
    taken.value *= factor;
    if (taken.u) *taken.u *= factor;
  }
  return taken;
}

void StudyJobs::require_calibration(const std::string& id) {
  const Result& found = result(id);
  if (found.calibration || (found.evaluation && found.evaluation->calibration != "none")) return;
  throw Error(ErrorCode::kCalibrationMissing,
              "job " + id + " was measured without constants of the instrument; see calibrate.accept");
}

void StudyJobs::note(const std::vector<std::string>& jobs, const std::string& evaluated_by, Study& study) {
  study.jobs = jobs;
  const Result& first = result(jobs.front());
  study.objective = first.objective;
  study.recipe_id = first.recipe.id;
  study.recipe_sha256 = first.recipe.sha256;
  bool recipes_differ = false;
  bool constants_differ = false;
  bool some_real = false;
  const auto constants_of = [](const Result& one) { return one.calibration ? one.calibration->id : std::string(); };
  for (const std::string& id : jobs) {
    const Result& next = result(id);
    if (next.objective != first.objective) {
      refuse("job " + id + " was measured with the objective '" + next.objective + "', job " + jobs.front() +
             " with '" + first.objective + "': a study is of one objective");
    }
    recipes_differ = recipes_differ || next.recipe.id != first.recipe.id;
    if (next.recipe.sha256 != first.recipe.sha256) study.recipe_sha256.clear();
    constants_differ = constants_differ || constants_of(next) != constants_of(first);
    study.simulated = study.simulated || next.provenance.simulated;
    some_real = some_real || !next.provenance.simulated;
  }
  if (study.simulated && some_real) refuse("some of the jobs were measured with a simulator and others were not");
  if (recipes_differ) {
    study.recipe_id.clear();
    study.recipe_sha256.clear();
    study.warnings.push_back({"recipes_differ", "the jobs were scanned with different recipes"});
  } else if (study.recipe_sha256 != first.recipe.sha256) {
    study.warnings.push_back({"recipe_changed", "recipe " + first.recipe.id + " was changed between the jobs"});
  }
  if (constants_differ) {
    study.warnings.push_back({"calibrations_differ", "the jobs were measured under different constants"});
  }
  if (evaluated_by.empty()) return;
  if (!recipe_) recipe_ = sources_.recipe(evaluated_by);
  study.recipe_id = recipe_->id;
  study.recipe_sha256 = recipe_->sha256;
}

metrology::Region region_of(const StudyRegion& region, const metrology::HeightField& field) {
  if (!region.rectangle) return {};
  const PlannedRectangle& r = *region.rectangle;
  const double width_um = field.width() * field.pitch_x_um;
  const double height_um = field.height() * field.pitch_y_um;
  constexpr double kSlack_um = 1e-9;
  if (r.x_um < 0.0 || r.y_um < 0.0 || r.x_um + r.width_um > width_um + kSlack_um ||
      r.y_um + r.height_um > height_um + kSlack_um) {
    throw Error(ErrorCode::kRegionOutside, "the region leaves the field, which is " + number_text(width_um) + " x " +
                                               number_text(height_um) + " um");
  }
  return metrology::rectangle_region(metrology::grid_of(field), {r.x_um, r.y_um, r.width_um, r.height_um});
}

}  // namespace fvd
