#pragma once

/// Values as colours: perceptually uniform scales that the colour-blind can read.

#include <array>
#include <cstdint>

#include "daemon/report/raster.hpp"
#include "daemon/report/scalar_image.hpp"

namespace fvd {

enum class ColourScale {
  kViridis,  ///< heights
  kMagma,    ///< standard errors: not to be taken for heights
};

/// From the least to the greatest value, each 0x00RRGGBB. Made once.
[[nodiscard]] const std::array<std::uint32_t, 256>& colours_of(ColourScale scale);

/// Values outside the range have its ends' colours; holes are grey.
[[nodiscard]] Raster coloured(const ScalarImage& image, const ValueRange& range, ColourScale scale);

inline constexpr std::uint32_t kHoleColour = 0x00AAAAAA;

}  // namespace fvd
