#pragma once

/// What is asked of each kind of study; described once for the API, for study.json and for people.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/fields.hpp"
#include "daemon/study/artefact_requests.hpp"
#include "daemon/study/study_parts.hpp"

namespace fvd {

/// verify.noise, calibrate.noise.
struct NoiseRequest {
  std::vector<std::string> jobs;  ///< 2 to 20 scans of one part
  StudyRegion region;
  void describe(Fields& fields);
};

/// verify.flatness, calibrate.flatness.
struct FlatnessRequest {
  std::vector<std::string> jobs;  ///< 1 to 20 positions of a flat
  std::optional<double> s_nesting_um;
  StudyRegion region;
  void describe(Fields& fields);
};

struct RequestedStep {
  std::string job;
  EvaluatedChoice what{"", "height_um"};
  double reference_um = 0.0;
  double u_reference_um = 0.0;
};

/// verify.step, calibrate.z.
struct StepRequest {
  std::vector<RequestedStep> steps;
  std::optional<double> u_common_relative;
  std::string recipe;  ///< whose evaluation the surfaces are given to anew; empty = the job's own values
  bool require_calibration = false;
  void describe(Fields& fields);
};

struct RequestedStepAtZ {
  std::string job;
  EvaluatedChoice what{"", "height_um"};
  double z_um = 0.0;
};

/// verify.linearity.
struct LinearityRequest {
  std::vector<RequestedStepAtZ> steps;
  std::string recipe;
  bool require_calibration = false;
  void describe(Fields& fields);
};

/// gauge.type1.
struct Type1Request {
  std::vector<std::string> jobs;
  EvaluatedChoice what;
  double reference = 0.0;
  double tolerance = 0.0;
  double tolerance_share = 0.2;
  double spread_sd = 6.0;
  double required = 1.33;
  std::optional<double> resolution;
  std::string recipe;
  bool require_calibration = false;
  void describe(Fields& fields);
};

/// gauge.rr.
struct RrRequest {
  int parts = 0;
  int operators = 0;
  int trials = 0;
  std::vector<std::string> jobs;  ///< part-major, then operator, then trial
  EvaluatedChoice what;
  std::optional<double> tolerance;
  double pooling_p = 0.25;
  double spread_sd = 6.0;
  std::string recipe;
  bool require_calibration = false;
  void describe(Fields& fields);
};

/// gauge.capability.
struct CapabilityRequest {
  std::string type1;  ///< identifier of a study
  std::string rr;
  std::optional<double> tolerance;  ///< absent = that of the type 1 study
  double u_calibration = 0.0;
  double u_linearity = 0.0;
  double u_stability = 0.0;
  double u_object = 0.0;
  double u_temperature = 0.0;
  double u_rest_system = 0.0;
  double u_rest_process = 0.0;
  double k = 2.0;
  void describe(Fields& fields);
};

using StudyInput = std::variant<NoiseRequest, FlatnessRequest, StepRequest, LinearityRequest, Type1Request, RrRequest,
                                CapabilityRequest, LateralRequest, ResolutionRequest, SphereRequest, HysteresisRequest,
                                TextureRequest>;

struct StudyRequest {
  std::string kind;    ///< the method: "verify.noise"; fits the input
  std::string person;  ///< who asks; may be empty
  StudyInput input;
};

/// calibrate.accept.
struct AcceptRequest {
  std::string study;
  std::string person;
  std::string certificate;
  std::string renew_by;  ///< "2027-11-29"
  std::optional<std::string> objective;
  void describe(Fields& fields);
};

}  // namespace fvd
