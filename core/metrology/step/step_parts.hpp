#pragma once

/// What the methods of step heights share.

#include <optional>
#include <span>
#include <string>

#include "core/metrology/step/joint_levels.hpp"
#include "core/metrology/step/refusal.hpp"
#include "core/metrology/step/step_height.hpp"

namespace fvd::metrology {

/// The height from `lower` to `upper` of a fit, perpendicular to the line (kX, kY) or plane (kBoth) of its slopes, with
/// its weights but without noise. sign: 1, or -1 for what is counted downwards.
[[nodiscard]] StepValue perpendicular_step(const HeightField& field, const PointGroups& groups,
                                           const JointLevels& levels, int upper, int lower, SlopeAxes perpendicular,
                                           double sign);

/// Adds factor * part. The part lies within the rectangle of the sum.
void add_scaled(const WeightMap& part, double factor, WeightMap& sum);

/// Mean and standard deviation of the traces' heights; two or more traces.
void summarize(StepTraces& traces);

/// A figure for a sentence, with four digits.
[[nodiscard]] std::string figure_text(double value);

/// The least valid fraction's region, where it is below `asked`, as a refusal. Empty otherwise.
[[nodiscard]] std::optional<StepRefusal> refused_for_holes(std::span<const StepRegion> regions, double asked);

}  // namespace fvd::metrology
