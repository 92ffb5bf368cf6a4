#pragma once

/// Height differences between regions that are given: no groove, and so not ISO 5436-1.

#include <string>
#include <utility>
#include <vector>

#include "core/metrology/step/refusal.hpp"
#include "core/metrology/step/step_height.hpp"
#include "core/runtime/worker_pool.hpp"

namespace fvd::metrology {

enum class StepSlope {
  kCommonPlane,  ///< one slope fitted to all regions jointly
  kFromLower,    ///< that of the lower region, carried over
  kFromUpper,
  kFixed,  ///< the surface is levelled already: no slope is fitted
};

/// A region by its name; an empty mask stands for the whole field.
struct NamedRegion {
  std::string name;
  const Region* region = nullptr;
};

struct RegionStep {
  StepValue value;  ///< upper less lower; negative where the one called upper lies lower
  StepSlope slope = StepSlope::kCommonPlane;
  StepRegion lower;
  StepRegion upper;
  /// Standard error over the one that a known slope would give: 2.0 for neighbours without a gap, 3.1 with a gap of
  /// a third of their length on each side.
  double correlation_factor = 1.0;
  std::string suggestion;  ///< not empty where the factor is above 3
};

/// step_between. Own definition. Regions must not share points. With a pool the same values. context: pure, as the
/// next.
[[nodiscard]] StepOutcome<RegionStep> step_between(const HeightField& field, const NamedRegion& lower,
                                                   const NamedRegion& upper, StepSlope slope,
                                                   double min_valid_fraction = 0.7, WorkerPool* pool = nullptr);

struct LevelDifference {
  int lower = 0;  ///< index into the regions as given
  int upper = 0;  ///< the later one
  StepValue value;
  double correlation_factor = 1.0;
};

struct Levels {
  std::vector<StepRegion> regions;
  std::vector<LevelDifference> differences;  ///< all pairs: (0, 1), (0, 2), ..., (1, 2), ...
  double slope_x = 0.0;
  double slope_y = 0.0;
};

/// Stairs: two to 200 regions in order, one common plane, every difference. Throws Error(kBadInput) for another number.
[[nodiscard]] StepOutcome<Levels> levels(const HeightField& field, const std::vector<NamedRegion>& regions,
                                         double min_valid_fraction = 0.7, WorkerPool* pool = nullptr);

}  // namespace fvd::metrology
