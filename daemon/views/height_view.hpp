#pragma once

/// A window of a map as viewers are sent it: a header and planes of floats, reduced where the window is larger.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "daemon/surface_files/map_rows.hpp"
#include "daemon/views/block_reducer.hpp"

namespace fvd {

/// In points of the map.
struct ViewWindow {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// 32 bytes: "FVDH", then little-endian 32-bit numbers: version 1, width, height, factor, planes, width and height of
/// the whole map. Then the planes, float32 little-endian, row by row from the top: the points themselves where the
/// factor is 1, else for each block of factor x factor points, counted from the window's corner, its value (see
/// BlockValue), its lowest and its highest. NaN = no valid point.
/// context: thread-safe; reads the map each time.
class HeightView {
 public:
  static constexpr std::size_t kHeader_bytes = 32;

  /// window: within the map, a point at least. most: no side is longer, >= 1; the factor is the least that does it.
  HeightView(std::shared_ptr<const MapRows> map, const ViewWindow& window, int most, BlockValue value);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int factor() const noexcept { return factor_; }
  [[nodiscard]] int planes() const noexcept { return factor_ == 1 ? 1 : 3; }
  /// Of the header and all planes.
  [[nodiscard]] std::uint64_t bytes() const noexcept;

  // All throw Error kSurfaceFile.

  [[nodiscard]] std::string header() const;
  /// All of it, in one pass over the map.
  [[nodiscard]] std::string whole() const;
  /// The rows [first, end) of one plane, for what is sent piece by piece.
  [[nodiscard]] std::string rows(int plane, int first, int end) const;

 private:
  /// Calls put(plane, row, values) with every row of the planes.
  template <typename Put>
  void make(int first, int end, const Put& put) const;

  std::shared_ptr<const MapRows> map_;
  ViewWindow window_;
  BlockValue value_;
  int factor_ = 1;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace fvd
