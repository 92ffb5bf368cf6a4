#pragma once

/// Rounds of fits with Tukey weights, for surfaces and profiles.

#include <functional>
#include <optional>
#include <span>

namespace fvd::metrology {

struct RobustRounds {
  int rounds = 1;
  bool converged = true;
  std::optional<double> cut_um;  ///< of the weights of the last fit
};

/// Makes fit() with the weights as they are, then again with Tukey weights (1 - (r / cut)^2)^2 of its residuals,
/// cut = kTukeyCut times the median of their absolute values, until the cut changes by less than kRobustChange of
/// itself (ISO 16610-31, -71), kMaxRobustRounds fits at most.
///
/// z_um: NaN = hole. weights: 1 on points and 0 in holes; changed. smooth_um: what fit() writes, NaN where it is not
/// determined; there the weight of the last round stays. Where more than half of the points are fitted exactly their
/// median tells no scale, and the cut is a thousandth of the largest residual (own definition). context: pure but for
/// fit().
RobustRounds fit_robustly(std::span<const double> z_um, std::span<double> weights, std::span<const double> smooth_um,
                          const std::function<void()>& fit);

}  // namespace fvd::metrology
