#pragma once

/// What an evaluation looks at, against the field of view: before anything is measured, and beside what was measured.

#include <set>
#include <string>
#include <vector>

#include "config/problem.hpp"
#include "core/metrology/operations/region.hpp"
#include "daemon/evaluation/evaluation_plan.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// Everything that no field of view can have, by its JSON pointer behind `place`: drawn regions left of or above the
/// first pixel, intersections of regions that lie apart. The plan was read; names may lead nowhere and in circles.
/// Own definition: regions are taken by the upright rectangles around them, so that nothing is refused wrongly.
/// context: pure.
[[nodiscard]] Problems outside_every_field(const EvaluationPlan& plan, const std::string& place);

/// Everything that has no point in this field of view, or leaves it where its measurement would be invalid: regions,
/// crops, bands and edges of grooves, ends of profiles. The plan was checked. Regions by the rectangles around them,
/// as above; what they let pass tells itself in the measurement. context: pure.
[[nodiscard]] Problems outside_field(const EvaluationPlan& plan, const metrology::Grid& field,
                                     const std::string& place);

/// The regions that the measurement, or a surface that it is made on, uses, with those that they are made of.
[[nodiscard]] std::set<std::string> used_regions(const EvaluationPlan& plan, const PlannedMeasurement& planned);

/// One warning for each drawn shape that the measurement, or a surface that it is made on, uses and that lies outside
/// of the field of view in part: with the share of its area outside, to 0.5 % of it. context: pure.
[[nodiscard]] std::vector<EvaluationWarning> partly_outside(const EvaluationPlan& plan,
                                                            const PlannedMeasurement& planned,
                                                            const metrology::Grid& field);

}  // namespace fvd
