#pragma once

/// Words about a measurement above its picture. Only sources of this folder include it.

#include <string>

#include "daemon/result/cross_section.hpp"
#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// "step: mean over 200 µm", or the name alone where nothing is averaged.
[[nodiscard]] std::string section_title(const std::string& name, const CrossSection& section);

/// Kind, main value with U and limits' verdict, or why there is none: "step_height, height 49.985 ± 0.048 µm, pass".
[[nodiscard]] std::string measurement_text(const EvaluatedMeasurement& measurement);

}  // namespace fvd
