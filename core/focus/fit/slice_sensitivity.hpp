#pragma once

/// How an error of one slice's z moves the heights that are fitted through it.

#include <span>
#include <vector>

namespace fvd {

/// A height and the weight with which it counts in an estimate.
struct WeightedHeight {
  double height_um = 0.0;
  double weight = 0.0;
};

/// For an estimate sum(weight * height), its derivative with respect to the z of each sample of the focus curve, in um
/// per um: the derivative of the five-sample fit of a Gaussian curve of this width (own definition), found by moving
/// one z. Heights that lie within 1/32 of a step count as one, and heights outside the range count for nothing.
///
/// sample_z_um: strictly rising or falling, at least 3. curve_width_um: full width at half maximum, > 0. Weights that
/// sum to 1 give derivatives that sum to 1, and those of a step give 0. context: pure.
[[nodiscard]] std::vector<double> slice_sensitivities(std::span<const double> sample_z_um, double curve_width_um,
                                                      std::span<const WeightedHeight> heights);

}  // namespace fvd
