#pragma once

/// Pixels of a picture that a page shows.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fvd {

/// Shape [height][width], row 0 on top, each pixel 0x00RRGGBB.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;

  Raster() = default;
  Raster(int columns, int rows, std::uint32_t fill)
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), fill) {}
  [[nodiscard]] std::uint32_t& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

}  // namespace fvd
