#include "config/field_writer.hpp"
#include "core/base/error.hpp"
#include "daemon/base/version.hpp"
#include "daemon/study/studies.hpp"

namespace fvd {

namespace {

struct OfJobs {
  StudyJobs& jobs;
  Purpose purpose;
  StudyDraft operator()(const NoiseRequest& request) const { return noise_study(request, purpose, jobs); }
  StudyDraft operator()(const FlatnessRequest& request) const { return flatness_study(request, purpose, jobs); }
  StudyDraft operator()(const StepRequest& request) const { return step_study(request, purpose, jobs); }
  StudyDraft operator()(const LinearityRequest& request) const { return linearity_study(request, jobs); }
  StudyDraft operator()(const Type1Request& request) const { return type1_study(request, jobs); }
  StudyDraft operator()(const RrRequest& request) const { return rr_study(request, jobs); }
  StudyDraft operator()(const LateralRequest& request) const { return lateral_study(request, jobs); }
  StudyDraft operator()(const ResolutionRequest& request) const { return resolution_study(request, jobs); }
  StudyDraft operator()(const SphereRequest& request) const { return sphere_study(request, jobs); }
  StudyDraft operator()(const HysteresisRequest& request) const { return hysteresis_study(request, jobs); }
  StudyDraft operator()(const TextureRequest& request) const { return texture_study(request, purpose, jobs); }
  StudyDraft operator()(const CapabilityRequest&) const {
    throw Error(ErrorCode::kStudyRefused, "a study of two other studies is not made of jobs");
  }
};

std::string inputs_text(StudyInput input) {
  return std::visit(
      [](auto& request) { return fields_to_json([&](Fields& fields) { request.describe(fields); }).dump(); }, input);
}

}  // namespace

void note_request(const StudyRequest& request, Study& study) {
  study.kind = request.kind;
  study.person = request.person;
  study.software_version = kVersion;
  study.inputs = inputs_text(request.input);
}

StudyDraft draft_of_jobs(const StudyRequest& request, StudyJobs& jobs) {
  const Purpose purpose = request.kind.starts_with("calibrate.") ? Purpose::kCalibrate : Purpose::kVerify;
  return std::visit(OfJobs{jobs, purpose}, request.input);
}

}  // namespace fvd
