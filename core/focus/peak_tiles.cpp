#include "core/focus/peak_tiles.hpp"

#include <algorithm>
#include <utility>

namespace fvd {

namespace {

constexpr float kLeastShare = 0.1F;

}  // namespace

PeakTiles::PeakTiles(int width, int height, int reach_px, bool root_code)
    : width_(width),
      height_(height),
      reach_px_(reach_px),
      unit_(static_cast<float>(root_code ? SharpnessCode::kUnit * SharpnessCode::kUnit : SharpnessCode::kUnit)),
      columns_((width + reach_px - 1) / reach_px),
      rows_((height + reach_px - 1) / reach_px),
      values_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

int PeakTiles::end(int tile_row) const noexcept { return std::min(height_, (tile_row + 1) * reach_px_); }

void PeakTiles::set_row(int tile_row, const std::uint32_t* highest) noexcept {
  float* tiles = values_.data() + static_cast<std::ptrdiff_t>(tile_row) * columns_;
  for (int column = 0; column < columns_; ++column) {
    const std::uint32_t* first = highest + column * reach_px_;
    const std::uint32_t* end = highest + std::min(width_, (column + 1) * reach_px_);
    tiles[column] = static_cast<float>(*std::max_element(first, end)) * unit_;
  }
}

void PeakTiles::spread() {
  std::vector<float> least(values_.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      float highest = 0.0F;
      for (int v = std::max(0, row - 1); v <= std::min(rows_ - 1, row + 1); ++v) {
        for (int u = std::max(0, column - 1); u <= std::min(columns_ - 1, column + 1); ++u) {
          highest = std::max(highest, values_[static_cast<std::size_t>(v * columns_ + u)]);
        }
      }
      least[static_cast<std::size_t>(row * columns_ + column)] = kLeastShare * highest;
    }
  }
  values_ = std::move(least);
}

void PeakTiles::least_amplitude(int tile_row, float* out) const noexcept {
  const float* tiles = values_.data() + static_cast<std::ptrdiff_t>(tile_row) * columns_;
  for (int column = 0; column < columns_; ++column) {
    std::fill(out + column * reach_px_, out + std::min(width_, (column + 1) * reach_px_), tiles[column]);
  }
}

}  // namespace fvd
