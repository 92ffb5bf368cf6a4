#pragma once

/// Why a step height is not given.

#include <optional>
#include <string>
#include <variant>

namespace fvd::metrology {

enum class StepRefusalCode {
  kTooFewValid,   ///< a region has fewer of its points than asked for; `figure` is the fraction
  kNoEdges,       ///< no groove or ridge stands out of the median trace
  kTooFewTraces,  ///< under five traces are left; `figure` is their number
  kOutside,       ///< the band or the traces do not lie in the field
  kOverlap,       ///< regions share points
  kNoSlope,       ///< the regions do not define the slope, e.g. all points in one column
  kNotRounded,    ///< the bottom has no vertex within the middle third
};

struct StepRefusal {
  StepRefusalCode code = StepRefusalCode::kTooFewValid;
  std::string text;  ///< one sentence with figures
  std::optional<double> figure;
};

/// What was asked for, or why it is not given.
template <typename T>
using StepOutcome = std::variant<T, StepRefusal>;

/// Stable name, e.g. "too_few_valid".
[[nodiscard]] const char* step_refusal_name(StepRefusalCode code) noexcept;

}  // namespace fvd::metrology
