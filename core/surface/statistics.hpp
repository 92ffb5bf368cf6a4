#pragma once

/// The heights of a surface in a few numbers.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/image/image.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {

/// Over the valid points, in um.
struct HeightValues {
  double min_um = 0.0;
  double max_um = 0.0;
  double mean_um = 0.0;
  double median_um = 0.0;
  double low_um = 0.0;   ///< 0.5 % of the points lie below; with high_um the range of a picture's colours
  double high_um = 0.0;  ///< 0.5 % of the points lie above
};

/// Points that carry a reason; a point with two reasons counts in both.
struct HoleCounts {
  std::size_t low_prominence = 0;
  std::size_t first_slice = 0;
  std::size_t last_slice = 0;
  std::size_t not_bracketed = 0;
  std::size_t saturated = 0;
  std::size_t insignificant = 0;
  std::size_t edge_bleeding = 0;
  std::size_t broad_curve = 0;
  std::size_t narrow_curve = 0;
  std::size_t second_peak = 0;
  std::size_t edge_band = 0;
  std::size_t max_sigma = 0;
  std::size_t out_of_view = 0;
  bool operator==(const HoleCounts&) const = default;
};

struct HeightSummary {
  std::size_t points = 0;
  std::size_t valid = 0;
  HoleCounts holes;
  std::optional<double> sigma_median_um;  ///< absent when every point is a hole
  std::optional<HeightValues> height;     ///< absent when every point is a hole

  [[nodiscard]] double valid_fraction() const {
    return points == 0 ? 0.0 : static_cast<double>(valid) / static_cast<double>(points);
  }
};

/// height_m, sigma_m: metres, NaN exactly where mask != 0. mask: 0 valid, else mask_reason bits. All have the same
/// shape [height][width]. Allocates a few MiB, whatever the size. context: pure.
[[nodiscard]] HeightSummary summarize_heights(const Plane<float>& height_m, const Plane<float>& sigma_m,
                                              const Plane<MaskReasons>& mask);

}  // namespace fvd
