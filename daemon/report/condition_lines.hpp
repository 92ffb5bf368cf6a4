#pragma once

/// Under which conditions the values of a result hold, as words.

#include <string>
#include <vector>

#include "daemon/result/result.hpp"

namespace fvd {

/// A paragraph: what it is about, and the words.
struct ConditionLine {
  std::string about;
  std::string text;
};

/// The surface and its window, each surface of the evaluation with its steps, each measurement with its points, noise
/// floor, what its U does not contain and warnings, the rule of decision, warnings of the result.
[[nodiscard]] std::vector<ConditionLine> condition_lines(const Result& result);

}  // namespace fvd
