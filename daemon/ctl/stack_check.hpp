#pragma once

/// Whether recorded slices and their heights can be what their recipe, or a microscope, would give.

#include <vector>

#include "daemon/ctl/process_stack.hpp"
#include "daemon/result/result.hpp"

namespace fvd::ctl {

/// z_um: of each slice. Returns what the result should warn of: another number of slices or another step than the
/// recipe's, another step than the names of the slices say, files that were ignored, a range within the width of the
/// focus curve, a unit that may be wrong. Throws Error kBadInput for fewer slices than a peak needs, and for a file
/// whose unit nobody said with steps far from the recipe's.
[[nodiscard]] std::vector<Warning> check_stack(const ProcessOptions& options, const std::vector<double>& z_um);

/// The recipe as these slices were taken: as many, and as far apart as they are unless that is what it plans; bins
/// follow from that.
[[nodiscard]] Recipe recipe_of_slices(const ProcessOptions& options, const std::vector<double>& z_um);

/// The median of the distances between neighbours, which slices that are missing in between do not change. At least
/// two.
[[nodiscard]] double median_step_um(const std::vector<double>& z_um);

}  // namespace fvd::ctl
