#pragma once

/// Turns a picture that optics or the way a camera is mounted show the wrong way round.

#include <cstdint>

#include "core/image/image.hpp"

namespace fvd {

/// Which way round a picture is. Both together are a turn by 180 degrees.
struct Mirror {
  bool x = false;  ///< left and right are exchanged
  bool y = false;  ///< top and bottom are exchanged

  [[nodiscard]] bool any() const { return x || y; }
  bool operator==(const Mirror&) const = default;
};

/// Exchanges columns, rows or both in place; doing it twice restores the picture. What pads the rows stays as it is.
/// context: thread-safe for different pictures.
void mirror_in_place(PlaneView<std::uint8_t> picture, const Mirror& mirror);
void mirror_in_place(PlaneView<std::uint16_t> picture, const Mirror& mirror);

}  // namespace fvd
