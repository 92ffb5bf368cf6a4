/// Studies along z: steps of known height, and one step at several heights.

#include <algorithm>
#include <cmath>

#include "core/metrology/study/step_linearity.hpp"
#include "core/metrology/uncertainty/budget.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

using metrology::KnownStep;

constexpr double kCoverage = 0.95;

/// The scans of one artefact.
struct Artefact {
  std::string job;   ///< the first of them
  std::string name;  ///< of the value
  double reference_um = 0.0;
  double u_reference_um = 0.0;
  std::vector<JobValue> values;
};

std::vector<Artefact> artefacts_of(const StepRequest& request, Corrected corrected, StudyJobs& jobs) {
  std::vector<Artefact> artefacts;
  for (const RequestedStep& step : request.steps) {
    const JobValue value = jobs.value(step.job, step.what, request.recipe, corrected);
    if (value.unit != "um") {
      throw Error(ErrorCode::kStudyRefused, "job " + step.job + ": " + value.name + " is no height in um");
    }
    const auto known = std::find_if(artefacts.begin(), artefacts.end(), [&](const Artefact& artefact) {
      return artefact.reference_um == step.reference_um && artefact.u_reference_um == step.u_reference_um;
    });
    if (known != artefacts.end()) {
      known->values.push_back(value);
    } else {
      artefacts.push_back({step.job, value.name, step.reference_um, step.u_reference_um, {value}});
    }
  }
  return artefacts;
}

/// The larger of what the budgets predict of the mean and of what its scans show, and what all scans share.
double u_of_mean(const Artefact& artefact, double mean) {
  const auto n = static_cast<double>(artefact.values.size());
  double predicted = 0.0;
  double common = 0.0;
  double squares = 0.0;
  for (const JobValue& value : artefact.values) {
    const double u_um = value.u.value_or(0.0);
    predicted += std::max(0.0, u_um * u_um - value.u_common * value.u_common);
    common = std::max(common, value.u_common);
    squares += (value.value - mean) * (value.value - mean);
  }
  const double observed = artefact.values.size() < 2 ? 0.0 : squares / (n - 1.0);
  return std::hypot(std::sqrt(std::max(predicted / n, observed) / n), common);
}

KnownStep known_step(const Artefact& artefact) {
  double sum = 0.0;
  for (const JobValue& value : artefact.values) sum += value.value;
  KnownStep step;
  step.reference_um = artefact.reference_um;
  step.u_reference_um = artefact.u_reference_um;
  step.measured_um = sum / static_cast<double>(artefact.values.size());
  step.u_measured_um = u_of_mean(artefact, step.measured_um);
  return step;
}

std::vector<std::string> distinct(std::vector<std::string> jobs) {
  std::vector<std::string> kept;
  for (std::string& job : jobs) {
    if (std::find(kept.begin(), kept.end(), job) == kept.end()) kept.push_back(std::move(job));
  }
  return kept;
}

template <typename Request>
std::vector<std::string> jobs_of(const Request& request) {
  std::vector<std::string> jobs;
  for (const auto& step : request.steps) jobs.push_back(step.job);
  return distinct(std::move(jobs));
}

/// A job counts once for one value: twice the same scan would look like two that agree.
template <typename Request>
void refuse_repeated(const Request& request) {
  for (std::size_t i = 0; i < request.steps.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto& a = request.steps[i];
      const auto& b = request.steps[j];
      if (a.job != b.job || a.what.measurement != b.what.measurement || a.what.value != b.what.value) continue;
      throw Error(ErrorCode::kStudyRefused, "job " + a.job + " is given twice with " + a.what.measurement);
    }
  }
}

template <typename Request>
void note_evaluated(const Request& request, StudyJobs& jobs, StudyDraft& draft) {
  const std::vector<std::string> ids = jobs_of(request);
  refuse_repeated(request);
  jobs.note(ids, request.recipe, draft.study);
  if (!request.require_calibration) return;
  for (const std::string& id : ids) jobs.require_calibration(id);
}

/// Of the reduced chi squared: residuals of ten times their standard uncertainty.
constexpr double kMostUnexplained = 100.0;

double coverage_of(const std::vector<KnownStep>& steps) {
  const bool stated = std::any_of(steps.begin(), steps.end(), [](const KnownStep& step) {
    return step.u_reference_um > 0.0 || step.u_measured_um > 0.0;
  });
  if (stated || steps.size() < 2) return metrology::coverage_factor(metrology::kInfiniteDof, kCoverage);
  return metrology::coverage_factor(static_cast<double>(steps.size()) - 1.0, kCoverage);
}

void warn_of_steps(const StepRequest& request, const metrology::ZAmplification& z, double k, Purpose purpose,
                   std::size_t artefacts, StudyDraft& draft) {
  if (artefacts == 1) {
    draft.warn("one_step", "one height says nothing of linearity; l_z needs steps of several heights");
  } else {
    const double dof = static_cast<double>(artefacts) - 1.0;
    if (z.reduced_chi_squared > 1.0 + 3.0 * std::sqrt(2.0 / dof)) {
      draft.warn("residuals_unexplained", "the residuals are " + number_text(std::sqrt(z.reduced_chi_squared)) +
                                              " times what the stated uncertainties explain: the axis is not linear, "
                                              "or an uncertainty is too small");
    }
  }
  if (request.u_common_relative.value_or(0.0) == 0.0 && artefacts > 1) {
    draft.warn("no_common_uncertainty",
               "no part of the certificates' uncertainty is told to be common to the steps, so that u falls with their "
               "number; see u_common_relative");
  }
  if (purpose == Purpose::kVerify && std::abs(z.alpha_z - 1.0) > k * z.u_alpha_z) {
    draft.warn("alpha_z_off", "alpha_z differs from 1 by more than its expanded uncertainty; see calibrate.z");
  }
}

void plot_residuals(const std::vector<KnownStep>& steps, const metrology::ZAmplification& z, StudyDraft& draft) {
  StudyPlot plot{
      "residuals: measured less alpha_z x reference, with 2 u", "reference height / µm", "residual / µm", {}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double u_um = std::hypot(steps[i].u_measured_um, steps[i].u_reference_um);
    plot.points.push_back({steps[i].reference_um, z.residuals_um[i], u_um});
  }
  draft.plot = std::move(plot);
}

}  // namespace

StudyDraft step_study(const StepRequest& request, Purpose purpose, StudyJobs& jobs) {
  StudyDraft draft;
  note_evaluated(request, jobs, draft);
  const Corrected corrected = purpose == Purpose::kCalibrate ? Corrected::kUndone : Corrected::kAsMeasured;
  const std::vector<Artefact> artefacts = artefacts_of(request, corrected, jobs);
  std::vector<KnownStep> steps;
  for (const Artefact& artefact : artefacts) steps.push_back(known_step(artefact));
  const metrology::ZAmplification z =
      accepted(metrology::z_amplification(steps, request.u_common_relative.value_or(0.0)));
  const double k = coverage_of(steps);
  draft.figure("alpha_z", z.alpha_z, "1", z.u_alpha_z, k);
  draft.figure("linearity_um", z.linearity_um, "um", z.u_linearity_um, k);
  draft.figure("reduced_chi_squared", z.reduced_chi_squared, "1");
  draft.figure("artefacts", static_cast<double>(steps.size()), "1");
  draft.figure("scans", static_cast<double>(request.steps.size()), "1");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    draft.study.values.push_back({artefacts[i].job, artefacts[i].name, steps[i].measured_um, steps[i].u_measured_um,
                                  steps[i].reference_um, z.residuals_um[i]});
  }
  warn_of_steps(request, z, k, purpose, steps.size(), draft);
  plot_residuals(steps, z, draft);
  if (purpose == Purpose::kCalibrate && z.reduced_chi_squared > kMostUnexplained) {
    draft.warn("nothing_proposed",
               "residuals so far beyond the stated uncertainties are a mistake in the input, or a "
               "stage to be mended: no constants are proposed");
  } else if (purpose == Purpose::kCalibrate) {
    Calibration proposal;
    proposal.objective = draft.study.objective;
    ZConstants constants;
    constants.alpha_z = z.alpha_z;
    constants.u_alpha_z = z.u_alpha_z;
    constants.linearity_um = steps.size() > 1 ? z.linearity_um : 0.0;
    proposal.z = constants;
    draft.study.proposal = proposal;
  }
  return draft;
}

StudyDraft linearity_study(const LinearityRequest& request, StudyJobs& jobs) {
  StudyDraft draft;
  note_evaluated(request, jobs, draft);
  std::vector<metrology::StepAtZ> steps;
  for (const RequestedStepAtZ& step : request.steps) {
    const JobValue value = jobs.value(step.job, step.what, request.recipe, Corrected::kAsMeasured);
    steps.push_back({step.z_um, value.value});
    draft.study.values.push_back({step.job, value.name, value.value, value.u, {}, {}});
  }
  const metrology::ZLinearity linearity = accepted(metrology::z_linearity(steps));
  const auto n = static_cast<double>(steps.size());
  draft.figure("linearity_um", linearity.linearity_um, "um");
  draft.figure("mean_um", linearity.mean_um, "um", linearity.sd_um / std::sqrt(n),
               metrology::coverage_factor(n - 1.0, kCoverage));
  draft.figure("sd_um", linearity.sd_um, "um");
  draft.figure("trend_um_per_mm", linearity.trend_um_per_mm, "um/mm");
  StudyPlot plot{"deviation from the mean", "z of the step / µm", "deviation / µm", {}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    draft.study.values[i].deviation = linearity.deviations_um[i];
    plot.points.push_back({steps[i].z_um, linearity.deviations_um[i], draft.study.values[i].u});
  }
  draft.plot = std::move(plot);
  return draft;
}

}  // namespace fvd
