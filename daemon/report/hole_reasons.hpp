#pragma once

/// The reasons of holes as people read them.

#include <cstdint>
#include <span>

#include "core/surface/mask_reason.hpp"

namespace fvd {

struct HoleReason {
  MaskReasons bit = 0;
  const char* name = "";
  std::uint32_t colour = 0;  ///< 0x00RRGGBB; no two look alike beside each other
};

/// In the order in which one is shown for a point that has several: what says most of the point first.
[[nodiscard]] std::span<const HoleReason> hole_reasons();

}  // namespace fvd
