#include "core/focus/measure/peak_tiles.hpp"

#include <algorithm>
#include <utility>

namespace fvd {

namespace {

constexpr float kMinAmplitudeShare = 0.07F;
constexpr int kSampledRowsPerTile = 5;  // enough: within a fifth of its size a window's sum hardly changes

}  // namespace

PeakTiles::PeakTiles(int width, int height, int reach_px, bool root_code, CurveOfRow curves)
    : width_(width),
      height_(height),
      reach_px_(reach_px),
      root_code_(root_code),
      curves_(std::move(curves)),
      columns_((width + reach_px - 1) / reach_px),
      rows_((height + reach_px - 1) / reach_px),
      highest_(static_cast<std::size_t>(width)) {
  for (auto& tiles : tiles_) tiles.resize(static_cast<std::size_t>(columns_));
}

void PeakTiles::look_at(int tile_row) {
  constexpr auto kUnit = static_cast<float>(SharpnessCode::kUnit);
  const float unit = root_code_ ? kUnit * kUnit : kUnit;  // a code's amplitude times this is a share
  std::fill(highest_.begin(), highest_.end(), 0U);
  const int end = std::min(height_, (tile_row + 1) * reach_px_);
  for (int y = tile_row * reach_px_; y < end; y += std::max(1, reach_px_ / kSampledRowsPerTile)) {
    const CurveRow curve = curves_(y);
    focus_kernels().raise_amplitudes(curve.peak, curve.minimum, root_code_, width_, highest_.data());
  }
  std::vector<float>& row = tiles(tile_row);
  for (int column = 0; column < columns_; ++column) {
    const auto first = highest_.begin() + column * reach_px_;
    const auto last = highest_.begin() + std::min(width_, (column + 1) * reach_px_);
    row[static_cast<std::size_t>(column)] = static_cast<float>(*std::max_element(first, last)) * unit;
  }
}

void PeakTiles::least_amplitude(int tile_row, float* out) {
  const int first = std::max(0, tile_row - 1);
  const int last = std::min(rows_ - 1, tile_row + 1);
  for (int row = first; row <= last; ++row) {
    if (row < first_seen_ || row > last_seen_) look_at(row);
  }
  first_seen_ = first;
  last_seen_ = last;
  std::vector<float> highest(static_cast<std::size_t>(columns_));
  for (int row = first; row <= last; ++row) {
    for (std::size_t column = 0; column < highest.size(); ++column) {
      highest[column] = std::max(highest[column], tiles(row)[column]);
    }
  }
  for (int column = 0; column < columns_; ++column) {
    const auto from = highest.begin() + std::max(0, column - 1);
    const auto end = highest.begin() + std::min(columns_, column + 2);
    std::fill(out + column * reach_px_, out + std::min(width_, (column + 1) * reach_px_),
              kMinAmplitudeShare * *std::max_element(from, end));
  }
}

}  // namespace fvd
