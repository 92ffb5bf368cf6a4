#pragma once

/// What is asked of studies of one artefact, and of two or more scans of one surface.

#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "daemon/study/study_parts.hpp"

namespace fvd {

/// calibrate.lateral.
struct LateralRequest {
  std::string job;  ///< a scan of a cross grid
  double grid_pitch_um = 0.0;
  double u_grid_relative = 0.0;
  std::string second_job;  ///< the grid at another height; empty = none
  StudyRegion region;
  void describe(Fields& fields);
};

/// verify.resolution.
struct ResolutionRequest {
  static constexpr const char* kStar = "star";
  static constexpr const char* kEdge = "edge";

  std::string job;
  std::string artefact;
  std::optional<double> height_um;  ///< of a star; absent = as it is measured near the rim
  std::optional<int> pairs;         ///< of a star's sectors; absent = found
  StudyRegion region;
  void describe(Fields& fields);
};

/// verify.sphere.
struct SphereRequest {
  std::string job;
  double radius_um = 0.0;
  double u_radius_um = 0.0;
  bool bowl = false;  ///< the surface is the inner side
  StudyRegion region;
  void describe(Fields& fields);
};

/// verify.hysteresis.
struct HysteresisRequest {
  std::string up;  ///< a job that was scanned upwards
  std::string down;
  StudyRegion region;
  void describe(Fields& fields);
};

/// verify.texture, calibrate.texture.
struct TextureRequest {
  std::vector<std::string> jobs;  ///< 2 to 200 scans of one surface, put in place anew each time
  EvaluatedChoice what;
  std::string recipe;
  bool require_calibration = false;
  void describe(Fields& fields);
};

}  // namespace fvd
