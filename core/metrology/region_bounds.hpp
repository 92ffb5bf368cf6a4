#pragma once

/// The rectangle that the points of a region take.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/metrology/height_field.hpp"

namespace fvd::metrology {

/// Columns [left, right) and rows [top, bottom).
struct RegionBounds {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
  [[nodiscard]] bool empty() const { return right <= left || bottom <= top; }
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
  bool operator==(const RegionBounds&) const = default;
};

namespace region_bounds {

inline constexpr int kAtOnce = 8;

[[nodiscard]] inline bool any_of_eight(const std::uint8_t* inside) {
  std::uint64_t word = 0;
  std::memcpy(&word, inside, sizeof word);
  return word != 0;
}

/// The first column inside; `end` where there is none.
[[nodiscard]] inline int first_inside(const std::uint8_t* inside, int end) {
  int column = 0;
  while (column + kAtOnce <= end && !any_of_eight(inside + column)) column += kAtOnce;
  while (column < end && inside[column] == 0) ++column;
  return column;
}

/// One past the last column inside, of a row that has one.
[[nodiscard]] inline int end_inside(const std::uint8_t* inside, int end) {
  while (end >= kAtOnce && !any_of_eight(inside + end - kAtOnce)) end -= kAtOnce;
  while (inside[end - 1] == 0) --end;
  return end;
}

}  // namespace region_bounds

/// Of a region of a field of this size; an empty region is every point. No points: {0, 0, 0, 0}. context: pure.
[[nodiscard]] inline RegionBounds bounds_of(const Region& region, int width, int height) {
  if (region.empty()) return {0, 0, width, height};
  RegionBounds bounds{width, height, 0, 0};
  for (int row = 0; row < height; ++row) {
    const std::uint8_t* inside = region.row(row);
    const int first = region_bounds::first_inside(inside, width);
    if (first == width) continue;
    bounds.left = std::min(bounds.left, first);
    bounds.right = std::max(bounds.right, region_bounds::end_inside(inside, width));
    bounds.top = std::min(bounds.top, row);
    bounds.bottom = row + 1;
  }
  return bounds.bottom == 0 ? RegionBounds{} : bounds;
}

}  // namespace fvd::metrology
