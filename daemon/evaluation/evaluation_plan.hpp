#pragma once

/// What a recipe's section "evaluation" says: surfaces, regions, measurements, and how values are judged.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image/image.hpp"
#include "core/surface/verdict.hpp"

namespace fvd {

/// The name of the surface that nothing was done to.
inline constexpr const char* kMeasuredSurface = "measured";

/// In um from the outer corner of the pixel in column 0 and row 0; x right, y down.
struct PlannedRectangle {
  double x_um = 0.0;
  double y_um = 0.0;
  double width_um = 0.0;   ///< > 0
  double height_um = 0.0;  ///< > 0
};

struct PlannedPoint {
  double x_um = 0.0;
  double y_um = 0.0;
};

/// A region as a picture: what a file masks/NAME.png beside the recipe holds. Who reads the recipe reads it too.
struct RegionMask {
  Plane<std::uint8_t> points;  ///< as large as the surface; 0 = outside of the region
  std::string sha256;          ///< of the file's bytes
};

struct PlannedRegion {
  std::string shape;  ///< rectangle_um, polygon_um, circle_um, mask_png, threshold_um, not, union, intersection
  PlannedRectangle rectangle;
  std::vector<PlannedPoint> polygon;
  PlannedPoint centre;             ///< of a circle
  double radius_um = 0.0;          ///< > 0
  std::string mask_png;            ///< name of a file, without a path: a key of EvaluationPlan::masks
  std::optional<double> above_um;  ///< threshold: heights of the surface that is evaluated
  std::optional<double> below_um;
  bool largest = false;            ///< threshold: only the largest connected part
  std::vector<std::string> parts;  ///< regions that not, union and intersection are made of
  double shrink_um = 0.0;          ///< >= 0: points so near to the region's border do not belong to it
};

/// One operation of a surface's chain; each has its own members of these.
struct PlannedOperation {
  std::string op = "level";
  double max_sigma_um = 1.0;          ///< mask_sigma
  std::vector<std::string> reasons;   ///< mask_reasons: points that carry one of these
  int window_px = 7;                  ///< outliers: odd
  double limit = 6.0;                 ///< outliers: deviations of the window
  std::string form = "plane";         ///< level, form
  int degree = 2;                     ///< form polynomial: 1..6
  std::string fit = "least_squares";  ///< level: least_squares, weighted, robust
  std::vector<std::string> regions;   ///< level, form: fitted to these; none = every point
  std::string side = "S";             ///< filter: S takes short wavelengths away, L long ones
  double nesting_um = 0.0;            ///< filter: > 0
  std::string method = "gaussian";    ///< filter: gaussian, gaussian_regression_1, gaussian_regression_2
  bool robust = false;                ///< filter
  bool keep_margin = false;           ///< filter: L by gaussian, also where the border distorts
  PlannedRectangle rectangle;         ///< crop
  double by_um = 0.0;                 ///< shift_z
};

struct PlannedSurface {
  std::string from = kMeasuredSurface;
  std::vector<PlannedOperation> steps;
};

struct PlannedChipping {
  double min_depth_um = 3.0;
  double min_width_um = 10.0;
  double max_unmeasured_fraction = 0.1;
};

struct PlannedMeasurement {
  std::string kind = "areal";
  std::string id;  ///< at most 4 characters, for PLCs; empty = the name's first 4
  std::string surface = kMeasuredSurface;
  double min_valid_fraction = 0.7;       ///< of each region; under it the measurement is invalid
  std::map<std::string, Limits> limits;  ///< by a value's name with its unit, e.g. "Sa_um"

  std::string region;  ///< areal, cutting_edge; empty = everywhere

  std::string method;                   ///< step_height: iso5436_a1 or iso5436_a2; cutting_edge: model or tolerance
  std::string across = "x";             ///< step_height: direction of the traces
  std::vector<double> band_from_to_um;  ///< step_height: in the other direction; empty = all
  int traces = 9;                       ///< step_height: >= 5
  std::vector<double> edges_um;         ///< step_height: where the groove begins and ends; empty = sought

  std::string lower;                   ///< step_between: a region
  std::string upper;                   ///< step_between: a region
  std::string slope = "common_plane";  ///< step_between
  std::vector<std::string> regions;    ///< levels: in order, two or more

  std::vector<std::string> parameters;  ///< areal, profile

  std::vector<double> from_um;  ///< profile: x, y
  std::vector<double> to_um;    ///< profile: x, y
  double band_width_um = 0.0;   ///< profile: mean over so much across; 0 = one line
  double nesting_um = 80.0;     ///< profile: of the L filter
  int sections = 5;             ///< profile

  std::string rake_side = "left";           ///< cutting_edge
  double sections_every_um = 10.0;          ///< cutting_edge
  std::string model = "conic";              ///< cutting_edge: conic or circle
  std::vector<double> flank_um;             ///< cutting_edge: from and to, distances from the edge
  double tolerance_um = 0.5;                ///< cutting_edge: method tolerance
  std::optional<PlannedChipping> chipping;  ///< cutting_edge
};

/// The name of a measurement in the results that PLCs read.
[[nodiscard]] inline std::string plc_id(const std::string& name, const PlannedMeasurement& measurement) {
  constexpr std::size_t kLength = 4;
  return measurement.id.empty() ? name.substr(0, kLength) : measurement.id;
}

struct PlannedDecision {
  std::string rule = "iso14253_1";  ///< iso14253_1, simple, guard_U
  double probability = 0.95;        ///< of conformity that pass and fail need
};

struct EvaluationPlan {
  std::map<std::string, PlannedSurface> surfaces;
  std::map<std::string, PlannedRegion> regions;
  std::map<std::string, PlannedMeasurement> measurements;
  PlannedDecision decision;
  std::optional<double> expansion_per_k;                           ///< of the part's material; absent = not known
  std::vector<std::string> order;                                  ///< of the measurements, as the document has them
  std::map<std::string, std::shared_ptr<const RegionMask>> masks;  ///< by file name; not of the document

  [[nodiscard]] bool empty() const { return measurements.empty(); }
};

}  // namespace fvd
