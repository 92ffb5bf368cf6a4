#pragma once

/// What requests of several kinds have in common.

#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"

namespace fvd {

/// In um, from the outer corner of the first pixel.
struct StudyCircle {
  double x_um = 0.0;
  double y_um = 0.0;
  double radius_um = 0.0;
};

/// The part of the field that counts: the points in both; without either all of it.
struct StudyRegion {
  std::optional<PlannedRectangle> rectangle;
  std::optional<StudyCircle> circle = {};
};

/// A value of a job's evaluation.
struct EvaluatedChoice {
  std::string measurement;
  std::string value;  ///< with its unit; empty = the measurement's main value
};

inline constexpr std::size_t kMaxStudyName_bytes = 64;
/// A job's id, or the folder of its result where there is no daemon.
inline constexpr std::size_t kMaxStudyJob_bytes = 4096;
inline constexpr NumberRange kStudyPlace_um{-1e6, 1e6};

// Their fields in a request; jobs and job are required.
void describe_jobs(Fields& fields, std::vector<std::string>& jobs, const char* meaning);
void describe_job(Fields& fields, std::string& job, const char* meaning = "job id");
void describe_region(Fields& fields, StudyRegion& region);
void describe_choice(Fields& fields, EvaluatedChoice& what);
void describe_evaluated(Fields& fields, std::string& recipe, bool& require_calibration);
void describe_optional(Fields& fields, const char* name, std::optional<double>& value, NumberRange range,
                       const char* meaning);

}  // namespace fvd
