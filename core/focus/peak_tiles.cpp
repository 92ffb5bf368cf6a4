#include "core/focus/peak_tiles.hpp"

#include <algorithm>

namespace fvd {

namespace {

constexpr float kLeastShare = 0.1F;

}  // namespace

PeakTiles::PeakTiles(int width, int height, int reach_px, bool root_code)
    : width_(width),
      height_(height),
      reach_px_(reach_px),
      root_code_(root_code),
      columns_((width + reach_px - 1) / reach_px),
      rows_((height + reach_px - 1) / reach_px),
      highest_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

int PeakTiles::end(int tile_row) const noexcept { return std::min(height_, (tile_row + 1) * reach_px_); }

void PeakTiles::add_row(int y, const CurveRow& row) noexcept {
  float* tiles = highest_.data() + static_cast<std::ptrdiff_t>(y / reach_px_) * columns_;
  for (int column = 0; column < columns_; ++column) {
    const int first = column * reach_px_;
    const float amplitude = focus_kernels().largest_amplitude(row.peak + first, row.minimum + first,
                                                              static_cast<float>(SharpnessCode::kUnit), root_code_,
                                                              std::min(width_, first + reach_px_) - first);
    tiles[column] = std::max(tiles[column], amplitude);
  }
}

void PeakTiles::least_amplitude(int y, float* out) const noexcept {
  const int tile_row = y / reach_px_;
  for (int column = 0; column < columns_; ++column) {
    float highest = 0.0F;
    for (int v = std::max(0, tile_row - 1); v <= std::min(rows_ - 1, tile_row + 1); ++v) {
      for (int u = std::max(0, column - 1); u <= std::min(columns_ - 1, column + 1); ++u) {
        highest = std::max(highest, highest_[static_cast<std::size_t>(v * columns_ + u)]);
      }
    }
    std::fill(out + column * reach_px_, out + std::min(width_, (column + 1) * reach_px_), kLeastShare * highest);
  }
}

}  // namespace fvd
