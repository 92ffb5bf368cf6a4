/// Studies of whole maps: noise, flatness, hysteresis.

#include <algorithm>
#include <cmath>
#include <span>

#include "core/metrology/artefact/hysteresis.hpp"
#include "core/metrology/study/flatness_study.hpp"
#include "core/metrology/study/noise_study.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

using metrology::HeightField;

std::vector<const HeightField*> pointers(const std::vector<HeightField>& fields) {
  std::vector<const HeightField*> all;
  for (const HeightField& field : fields) all.push_back(&field);
  return all;
}

/// So many points' squares count as one: the sum of the squared correlations of neighbours that the window makes, of
/// both directions. Own definition, from the variance of a variance of a normal process.
double squares_as_one(const LateralKernel& kernel) {
  const std::vector<double>& w = kernel.weights;
  const auto lagged = [&w](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < w.size(); ++i) sum += w[i] * w[i + lag];
    return sum;
  };
  double sum = 1.0;
  for (std::size_t lag = 1; lag < w.size(); ++lag) {
    const double correlation = lagged(lag) / lagged(0);
    sum += 2.0 * correlation * correlation;
  }
  return sum * sum;
}

void check_count(const std::vector<std::string>& jobs, std::size_t least) {
  constexpr std::size_t kMost = 20;
  if (jobs.size() < least || jobs.size() > kMost) {
    throw Error(ErrorCode::kStudyRefused, std::to_string(jobs.size()) + " jobs were given, " + std::to_string(least) +
                                              " to " + std::to_string(kMost) + " make this study");
  }
  refuse_repeated_jobs(jobs);
}

double quadratic_mean(const Plane<float>& values) {
  double squares = 0.0;
  std::size_t count = 0;
  for (const float value : values.pixels()) {
    if (std::isnan(value)) continue;
    squares += static_cast<double>(value) * static_cast<double>(value);
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

void note_valid(double valid_fraction, StudyDraft& draft) {
  constexpr double kFew = 0.7;
  draft.figure("valid_fraction", valid_fraction, "1");
  if (valid_fraction >= kFew) return;
  draft.warn("few_points", "only " + number_text(100.0 * valid_fraction) +
                               " % of the region's points are valid in every scan; the figures are those of the rest");
}

double mean_scan_ms(const std::vector<std::string>& ids, StudyJobs& jobs) {
  double sum_ms = 0.0;
  for (const std::string& id : ids) sum_ms += jobs.result(id).times.scan_ms;
  return sum_ms / static_cast<double>(ids.size());
}

/// Scans in one direction would show repeatability in place of hysteresis.
void check_directions(const HysteresisRequest& request, StudyJobs& jobs, StudyDraft& draft) {
  const auto rise_um = [&jobs](const std::string& id) -> std::optional<double> {
    const Result::Slices& slices = jobs.result(id).slices;
    if (!slices.first_um || !slices.last_um) return std::nullopt;
    return *slices.last_um - *slices.first_um;
  };
  const std::optional<double> up = rise_um(request.up);
  const std::optional<double> down = rise_um(request.down);
  if (up && *up <= 0.0) {
    throw Error(ErrorCode::kStudyRefused, "job " + request.up + " was not scanned upwards");
  }
  if (down && *down >= 0.0) {
    throw Error(ErrorCode::kStudyRefused, "job " + request.down + " was not scanned downwards");
  }
  if (!up || !down) draft.warn("direction_unknown", "a job does not tell in which direction it was scanned");
}

/// What the encoder tells of the two scans: heights have it in them already.
void note_stage(const HysteresisRequest& request, StudyJobs& jobs, StudyDraft& draft) {
  const StepSummary& up = jobs.result(request.up).steps;
  const StepSummary& down = jobs.result(request.down).steps;
  const bool known = up.steps > 0 && down.steps > 0;
  draft.figure("stage_difference_um", known ? std::optional(down.error_mean_um - up.error_mean_um) : std::nullopt, "um",
               "the jobs do not tell measured positions");
}

Plane<float> difference_of(const HeightField& up, const HeightField& down) {
  Plane<float> um = Plane<float>::unset(up.width(), up.height());
  for (int y = 0; y < up.height(); ++y) {
    for (int x = 0; x < up.width(); ++x) um.at(x, y) = static_cast<float>(down.z_um.at(x, y) - up.z_um.at(x, y));
  }
  return um;
}

}  // namespace

StudyDraft noise_study(const NoiseRequest& request, Purpose purpose, StudyJobs& jobs) {
  check_count(request.jobs, 2);
  StudyDraft draft;
  jobs.note(request.jobs, "", draft.study);
  if (!jobs.of_one_part(request.jobs)) {
    draft.warn("parts_differ", "the jobs name different parts; noise is that of one part that does not move");
  }
  const std::vector<HeightField> fields = jobs.fields(request.jobs);
  const metrology::NoiseStudy noise =
      accepted(metrology::measurement_noise(pointers(fields), region_of(request.region, fields.front())));
  const double squares = (noise.scans - 1.0) * noise.points / squares_as_one(fields.front().kernel);
  draft.figure("noise_um", noise.noise_um, "um", noise.noise_um / std::sqrt(2.0 * squares));
  draft.figure("scans", noise.scans, "1");
  draft.figure("points", noise.points, "1");
  note_valid(noise.valid_fraction, draft);
  draft.figure("sigma_seen_over_told", noise.over_sigma, "1", "the jobs have no standard errors");
  const double scan_ms = mean_scan_ms(request.jobs, jobs);
  draft.figure("scan_time_ms", std::isfinite(scan_ms) ? std::optional(scan_ms) : std::nullopt, "ms",
               "the jobs do not tell it");
  constexpr double kFar = 1.5;
  if (noise.over_sigma && (*noise.over_sigma > kFar || *noise.over_sigma < 1.0 / kFar)) {
    draft.warn("sigma_untrue", "the noise seen is " + number_text(*noise.over_sigma) +
                                   " times what the jobs' standard errors tell; uncertainties that rest on them are "
                                   "wrong by as much");
  }
  draft.map = study_map(noise.noise_map_um, fields.front(), "standard deviation / µm", true);
  draft.files.push_back({"noise_map.gsf", gsf_of_um(noise.noise_map_um, fields.front().pitch_x_um,
                                                    fields.front().pitch_y_um, "standard deviation over the scans")});
  if (purpose == Purpose::kCalibrate) {
    draft.study.proposal = proposal_for(draft.study);
    draft.study.proposal->noise = NoiseConstants{noise.noise_um, {}};
  }
  return draft;
}

StudyDraft flatness_study(const FlatnessRequest& request, Purpose purpose, StudyJobs& jobs) {
  check_count(request.jobs, 1);
  StudyDraft draft;
  jobs.note(request.jobs, "", draft.study);
  const std::vector<HeightField> fields = jobs.fields(request.jobs, request.s_nesting_um);
  const HeightField& like = fields.front();
  const metrology::FlatnessStudy flat =
      accepted(metrology::flatness_deviation(pointers(fields), region_of(request.region, like)));
  const bool has_errors = flat.reference.has_sigma();
  const double u_um = has_errors ? quadratic_mean(flat.reference.sigma_um) : 0.0;
  draft.figure("flatness_um", flat.flatness_um, "um");
  draft.figure("u_reference_um", has_errors ? std::optional(u_um) : std::nullopt, "um",
               "from one position the scatter is not known");
  draft.figure("positions", flat.positions, "1");
  draft.figure("points", flat.points, "1");
  note_valid(flat.valid_fraction, draft);
  if (flat.positions == 1) {
    draft.warn("one_position", "from one position the flat's own form and the noise are in the figure");
  }
  if (has_errors && flat.flatness_um < 2.0 * u_um) {
    draft.warn("below_noise", "z_FLT is below twice the reference map's standard error: more positions would lower it");
  }
  const Plane<float> map_um = floats_of(flat.reference.z_um);
  draft.map = study_map(map_um, like, "mean deviation / µm", false);
  draft.files.push_back(
      {"flatness_reference.gsf", gsf_of_um(map_um, like.pitch_x_um, like.pitch_y_um, "mean deviation from a plane")});
  if (has_errors) {
    draft.files.push_back({"flatness_sigma.gsf", gsf_of_um(flat.reference.sigma_um, like.pitch_x_um, like.pitch_y_um,
                                                           "standard error of the mean deviation")});
  }
  if (purpose == Purpose::kCalibrate) {
    if (!has_errors) draft.study.refusals.push_back({"one_position", "a reference map needs two positions or more"});
    draft.study.proposal = proposal_for(draft.study);
    draft.study.proposal->flatness = FlatnessConstants{flat.flatness_um, u_um, "flatness_reference.gsf", {}};
  }
  return draft;
}

StudyDraft hysteresis_study(const HysteresisRequest& request, StudyJobs& jobs) {
  const std::vector<std::string> ids{request.up, request.down};
  refuse_repeated_jobs(ids);
  StudyDraft draft;
  jobs.note(ids, "", draft.study);
  if (!jobs.of_one_part(ids)) {
    draft.warn("parts_differ", "the jobs name different parts; hysteresis is that of one part that does not move");
  }
  // Up and down are two recipes, or two settings of one.
  std::erase_if(draft.study.warnings, [](const StudyWarning& warning) { return warning.code == "recipes_differ"; });
  check_directions(request, jobs, draft);
  const std::vector<HeightField> fields = jobs.fields(ids);
  const HeightField& up = fields.front();
  const metrology::Hysteresis found = accepted(metrology::hysteresis(up, fields.back(), region_of(request.region, up)));
  constexpr double kPerMm = 1000.0;
  draft.figure("mean_um", found.mean_um, "um", found.u_mean_um);
  draft.figure("slope_x_um_per_mm", kPerMm * found.slope_x, "um/mm");
  draft.figure("slope_y_um_per_mm", kPerMm * found.slope_y, "um/mm");
  draft.figure("rest_um", found.rest_um, "um");
  note_stage(request, jobs, draft);
  draft.figure("points", found.points, "1");
  note_valid(found.valid_fraction, draft);
  if (std::abs(found.mean_um) > 2.0 * found.u_mean_um) {
    draft.warn("hysteresis", "heights differ by " + number_text(found.mean_um) +
                                 " um with the direction of the scan, which the measured positions do not explain");
  }
  const Plane<float> difference_um = difference_of(up, fields.back());
  draft.map = study_map(difference_um, up, "down less up / µm", false);
  draft.files.push_back({"difference.gsf", gsf_of_um(difference_um, up.pitch_x_um, up.pitch_y_um,
                                                     "heights seen downwards less those seen upwards")});
  return draft;
}

}  // namespace fvd
