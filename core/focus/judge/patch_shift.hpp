#pragma once

/// How far the texture of a slice's patches has moved since the slice before, to a fraction of a pixel.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image/image.hpp"

namespace fvd {

/// Patches of a slice, filtered: a blur of 7 x 7 pixels, and of that the second differences over 5 pixels. The filter
/// sees neither brightness nor a slope of it.
struct SlicePatches {
  int side = 0;                                   ///< of a filtered patch, in pixels
  std::vector<std::vector<std::int16_t>> values;  ///< of each patch, shape [side][side]
  std::vector<double> x_px;                       ///< middle of each patch, from the middle of the image
  std::vector<double> y_px;
};

/// Up to 3 x 3 patches, evenly spread, always at the same places; none in images of less than 64 pixels to a side.
/// context: pure.
[[nodiscard]] SlicePatches slice_patches(const ImageView& slice);

/// Largest shift that is found, in pixels in each direction.
inline constexpr int kMaxPatchShift_px = 5;

struct PatchShift {
  double x_px = 0.0;  ///< the texture moved right by so much
  double y_px = 0.0;  ///< and down
  /// Inverse of the error's covariance, to a factor that the patches of a pair of slices have in common: the marks of a
  /// tool tell little of a shift along them.
  double weight_xx = 0.0;
  double weight_xy = 0.0;
  double weight_yy = 0.0;
};

/// The vertex of the normalised correlation of two patches of the same place. guess: where the search begins, in
/// pixels. Nothing where the correlation stays below 0.4, as of noise. context: pure.
[[nodiscard]] std::optional<PatchShift> patch_shift(const std::vector<std::int16_t>& before,
                                                    const std::vector<std::int16_t>& after, int side, int guess_x,
                                                    int guess_y);

}  // namespace fvd
