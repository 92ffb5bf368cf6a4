#pragma once

/// The main figures of a stage report as short lines for a page.

#include <string>
#include <vector>

#include "core/stage/stage_report.hpp"

namespace fvd {

struct FigureLine {
  std::string name;
  std::string value;  ///< with unit; empty: `name` is the heading of the lines after it
};

/// Only what is known: an unknown figure has no line. ASCII.
[[nodiscard]] std::vector<FigureLine> figure_lines(const StageReport& report);

}  // namespace fvd
