#include "core/image/mirror.hpp"

#include <algorithm>

namespace fvd {

namespace {

template <typename Pixel>
void exchange(PlaneView<Pixel> picture, const Mirror& mirror) {
  for (int y = 0; mirror.x && y < picture.height; ++y) std::reverse(picture.row(y), picture.row(y) + picture.width);
  for (int y = 0; mirror.y && y < picture.height / 2; ++y) {
    std::swap_ranges(picture.row(y), picture.row(y) + picture.width, picture.row(picture.height - 1 - y));
  }
}

}  // namespace

void mirror_in_place(PlaneView<std::uint8_t> picture, const Mirror& mirror) { exchange(picture, mirror); }
void mirror_in_place(PlaneView<std::uint16_t> picture, const Mirror& mirror) { exchange(picture, mirror); }

}  // namespace fvd
