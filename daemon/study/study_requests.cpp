#include "daemon/study/study_requests.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxName_bytes = kMaxStudyName_bytes;
constexpr NumberRange kHeight_um{-1e6, 1e6};
constexpr NumberRange kUncertainty{0.0, 1e6};

}  // namespace

void NoiseRequest::describe(Fields& fields) {
  describe_jobs(fields, jobs, "ids of 2 to 20 scans of one part that was not moved");
  describe_region(fields, region);
}

void FlatnessRequest::describe(Fields& fields) {
  describe_jobs(fields, jobs, "ids of 1 to 20 scans of a flat, each at another place of it");
  describe_optional(fields, "s_nesting_um", s_nesting_um, positive(1e6),
                    "nesting index of the S-filter (Gaussian) that each map is given to first; absent = none");
  describe_region(fields, region);
}

void StepRequest::describe(Fields& fields) {
  fields.list("steps", steps, {1, 200}, "one for each job; those of equal reference and u are scans of one artefact",
              [](Fields& in, RequestedStep& step) {
                describe_job(in, step.job);
                describe_choice(in, step.what);
                in.number("reference_um", step.reference_um, kHeight_um, "height by the certificate");
                in.require("reference_um");
                in.number("u_reference_um", step.u_reference_um, kUncertainty,
                          "standard uncertainty of the certificate: its U over its k");
                in.require("u_reference_um");
              });
  fields.require("steps");
  describe_optional(fields, "u_common_relative", u_common_relative, {0.0, 0.1},
                    "part of the certificates' uncertainty that all steps share, over the height; absent = none");
  describe_evaluated(fields, recipe, require_calibration);
}

void LinearityRequest::describe(Fields& fields) {
  fields.list("steps", steps, {2, 200}, "one step, measured at several z", [](Fields& in, RequestedStepAtZ& step) {
    describe_job(in, step.job);
    describe_choice(in, step.what);
    in.number("z_um", step.z_um, kStudyPlace_um, "where the step was");
    in.require("z_um");
  });
  fields.require("steps");
  describe_evaluated(fields, recipe, require_calibration);
}

void Type1Request::describe(Fields& fields) {
  describe_jobs(fields, jobs, "ids of 25 or more scans of one part, at least 2");
  describe_choice(fields, what);
  fields.number("reference", reference, {-1e9, 1e9}, "true value of the part");
  fields.require("reference");
  fields.number("tolerance", tolerance, positive(1e9), "upper less lower limit");
  fields.require("tolerance");
  fields.number("tolerance_share", tolerance_share, positive(1.0), "of the tolerance that the gauge may use");
  fields.number("spread_sd", spread_sd, positive(20.0), "width of its spread in standard deviations");
  fields.number("required", required, positive(100.0), "of Cg and Cgk");
  describe_optional(fields, "resolution", resolution, positive(1e9), "smallest step of the value; absent = not judged");
  describe_evaluated(fields, recipe, require_calibration);
}

void RrRequest::describe(Fields& fields) {
  fields.integer("parts", parts, {2, 1000}, "number of parts");
  fields.require("parts");
  fields.integer("operators", operators, {1, 100}, "number of operators; with one there is no reproducibility");
  fields.require("operators");
  fields.integer("trials", trials, {2, 100}, "of each part by each operator");
  fields.require("trials");
  describe_jobs(fields, jobs, "job ids: part by part, in it operator by operator, in it trial by trial");
  describe_choice(fields, what);
  describe_optional(fields, "tolerance", tolerance, positive(1e9), "upper less lower limit; absent = not judged by it");
  fields.number("pooling_p", pooling_p, {0.0, 1.0}, "above it the interaction is pooled with the repeatability");
  fields.number("spread_sd", spread_sd, positive(20.0), "width of a spread in standard deviations");
  describe_evaluated(fields, recipe, require_calibration);
}

void CapabilityRequest::describe(Fields& fields) {
  fields.text("type1", type1, kMaxName_bytes, "id of a study of the kind gauge.type1");
  fields.require("type1");
  fields.text("rr", rr, kMaxName_bytes, "id of a study of the kind gauge.rr of the same value");
  fields.require("rr");
  describe_optional(fields, "tolerance", tolerance, positive(1e9), "absent = that of the type 1 study");
  fields.number("u_calibration", u_calibration, kUncertainty, "standard uncertainty of the reference, u_CAL");
  fields.number("u_linearity", u_linearity, kUncertainty, "of the linearity, u_LIN");
  fields.number("u_stability", u_stability, kUncertainty, "of the stability, u_STAB");
  fields.number("u_object", u_object, kUncertainty, "of the part's form, u_OBJ");
  fields.number("u_temperature", u_temperature, kUncertainty, "of the temperature, u_T");
  fields.number("u_rest_system", u_rest_system, kUncertainty, "of the rest of the system, u_MS-REST");
  fields.number("u_rest_process", u_rest_process, kUncertainty, "of the rest of the process, u_REST");
  fields.number("k", k, positive(10.0), "coverage factor");
}

void AcceptRequest::describe(Fields& fields) {
  fields.text("study", study, kMaxName_bytes, "id of the study that proposes the constants");
  fields.require("study");
  fields.text("person", person, kMaxName_bytes, "who accepts them");
  fields.require("person");
  fields.text("renew_by", renew_by, kMaxName_bytes, "the last day that they are trusted on, as 2027-11-29");
  fields.require("renew_by");
  fields.text("certificate", certificate, kMaxName_bytes, "number of the artefact's certificate; empty = none");
  fields.optional("objective", objective, [](Fields& in, std::string& name) {
    in.text("objective", name, kMaxName_bytes, "must be that of the study; absent = that of the study");
  });
}

}  // namespace fvd
