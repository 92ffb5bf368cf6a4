#pragma once

/// The studies themselves, one function a kind: from jobs to figures. Nothing is kept here.

#include <string>
#include <vector>

#include "daemon/study/study_draft.hpp"
#include "daemon/study/study_jobs.hpp"
#include "daemon/study/study_requests.hpp"

namespace fvd {

/// Whether constants are proposed: calibrate.* in place of verify.*.
enum class Purpose { kVerify, kCalibrate };

// All throw what StudyJobs throws, and Error kStudyRefused with the sentence of core/metrology/study. Noise as the
// focus window correlates it. context: pure but for the files that StudyJobs reads.

/// N_M with a map of it, its standard uncertainty from the number of independent points, and sigma seen over told.
[[nodiscard]] StudyDraft noise_study(const NoiseRequest& request, Purpose purpose, StudyJobs& jobs);

/// z_FLT with the reference map and its standard error.
[[nodiscard]] StudyDraft flatness_study(const FlatnessRequest& request, Purpose purpose, StudyJobs& jobs);

/// alpha_z and l_z. Scans of steps with equal reference and uncertainty are of one artefact: their mean counts once,
/// with the larger of its predicted and its observed standard uncertainty; what their budgets share (flatness,
/// temperature) does not average. To verify, values are as the constants in
/// force corrected them; to calibrate, as the axis gave them.
[[nodiscard]] StudyDraft step_study(const StepRequest& request, Purpose purpose, StudyJobs& jobs);

/// l_z over the range.
[[nodiscard]] StudyDraft linearity_study(const LinearityRequest& request, StudyJobs& jobs);

/// Cg, Cgk, bias.
[[nodiscard]] StudyDraft type1_study(const Type1Request& request, StudyJobs& jobs);

/// EV, AV, INT, GRR, PV, TV, %GRR, ndc.
[[nodiscard]] StudyDraft rr_study(const RrRequest& request, StudyJobs& jobs);

/// Pitch, shear and mapping deviations; with a second job how the picture moves with z. Each job's z is the mean of its
/// heights, for where the surface is in focus the picture shows it.
[[nodiscard]] StudyDraft lateral_study(const LateralRequest& request, StudyJobs& jobs);

/// W_R and D_LIM, of a star by direction.
[[nodiscard]] StudyDraft resolution_study(const ResolutionRequest& request, StudyJobs& jobs);

/// P_F, P_S and the slope limit. Refused where the region has the base that the cap stands on: the refusal tells the
/// circle that keeps it out.
[[nodiscard]] StudyDraft sphere_study(const SphereRequest& request, StudyJobs& jobs);

/// The difference of a scan downwards from one upwards, its plane, and what the encoder tells of it.
[[nodiscard]] StudyDraft hysteresis_study(const HysteresisRequest& request, StudyJobs& jobs);

/// Relative standard deviation of a value over jobs, in percent.
[[nodiscard]] StudyDraft texture_study(const TextureRequest& request, Purpose purpose, StudyJobs& jobs);

/// Every study but those of two others. Throws Error kStudyRefused for gauge.capability.
[[nodiscard]] StudyDraft draft_of_jobs(const StudyRequest& request, StudyJobs& jobs);

/// What the study tells of its request: kind, person, parameters, and this software's version.
void note_request(const StudyRequest& request, Study& study);

/// Q_MS and Q_MP. Throws Error kStudyRefused where the two are of different values, recipes or objectives, or of
/// another kind.
[[nodiscard]] StudyDraft capability_study(const CapabilityRequest& request, const Study& type1, const Study& rr);

/// The settings with which a stored study was made; for gauge.capability and newest_repeatability(). Throws Error
/// kBadInput where inputs are not those of the kind.
[[nodiscard]] Type1Request type1_request_of(const Study& study);
[[nodiscard]] RrRequest rr_request_of(const Study& study);

/// Standard deviation of repeated measurements of one part, with its degrees of freedom, of a gauge study; nothing for
/// other kinds.
struct GaugeRepeatability {
  std::string name;  ///< "step.height_um"
  double sd = 0.0;
  double dof = 0.0;
};
[[nodiscard]] std::optional<GaugeRepeatability> repeatability_of(const Study& study);

}  // namespace fvd
