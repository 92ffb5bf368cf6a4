#pragma once

/// The mean of traces, with the weights and the noise of the mean.

#include <vector>

#include "core/metrology/step/groove_layout.hpp"
#include "core/metrology/step/step_height.hpp"

namespace fvd::metrology {

/// A trace that was measured.
struct MeasuredTrace {
  StepTrace trace;
  StepValue value;  ///< its noise need not be there
};

/// Traces into the list with mean and standard deviation.
[[nodiscard]] StepTraces list_of(const std::vector<MeasuredTrace>& traces, int left_out);

/// The mean height; u of it honours the noise of neighbouring traces that see the same points.
[[nodiscard]] StepValue mean_of(const HeightField& field, const std::vector<MeasuredTrace>& traces);

/// Traces along y: what was measured on the transposed field, told of the field itself.
void turn_back(StepValue& value);

}  // namespace fvd::metrology
