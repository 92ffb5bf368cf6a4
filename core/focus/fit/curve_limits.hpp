#pragma once

/// How broad and how narrow a point's focus curve may be, told from the scan's own curves.
///
/// Too broad: the blur of a bright neighbour makes a hump in windows that hold hardly any texture of their own. Too
/// narrow: a pixel that blinks, dust that moved, a flash are sharp in one slice. Both are judged against the median of
/// the scan. Where a surface has no texture and the few points that have a peak blink, the median itself is wrong; that
/// shows in the samples beside the peaks, which then are no higher than those two away. A peak must then have three
/// samples above half of its height, as every curve has whose slices are not far apart.

#include <limits>
#include <span>
#include <vector>

#include "core/focus/fit/curve_tuple.hpp"
#include "core/focus/measure/focus_settings.hpp"

namespace fvd {

/// Shares are those of a curve's amplitude over its floor, see five_sample_fit.hpp.
struct CurveLimits {
  static constexpr double kNoShoulder = -1e30;
  /// Only lower neighbours than this, together, are asked for a shoulder: of higher ones noise makes too much.
  static constexpr float kMostNeighbours = 1.2F;

  double least_bend_per_um2 = 0.0;                                     ///< of G; below it a curve is too broad
  double most_bend_per_um2 = std::numeric_limits<double>::infinity();  ///< whose neighbours are too low
  double least_neighbours = 0.0;  ///< sum of both neighbours' shares, whatever the bend
  /// (both neighbours' shares less those of the samples two away) over (2 less both neighbours' shares): of a spike
  /// near 0, of a curve 0.2 and more, the more samples it has.
  double least_shoulder = kNoShoulder;
  bool logarithm = false;  ///< G is that of curves without heavy tails, see five_sample_fit.hpp

  /// What the neighbours of a peak must have together where samples lie scale_um apart.
  [[nodiscard]] double neighbours(double scale_um) const noexcept;
};

/// tuples: from `looked_at` points spread over the image, their indices within z_um. Fewer than 500 points tell
/// nothing: no limits then. logarithm: of the fit that they are for. context: pure.
[[nodiscard]] CurveLimits curve_limits(std::span<const CurveTuple> tuples, std::size_t looked_at,
                                       const std::vector<double>& z_um, const PointTests& tests,
                                       bool logarithm = false);

}  // namespace fvd
