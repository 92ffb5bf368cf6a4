#include "core/focus/measure/noise_probe.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace fvd {

namespace {

constexpr int kTile_px = 128;
constexpr int kRowStep = 16;
constexpr double kRounding = 0.28867513459481287;  // 1 / sqrt(12) grey levels
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::array kNothing{kInfinite, kInfinite, kInfinite};
/// Fewer slices can spare one mean, or none.
constexpr int kSlicesForThird = 8;
constexpr int kSlicesForSecond = 5;
/// Standard error of one mean over a tile. Half of the slices are taken to show noise alone there.
constexpr double kMeanError = 0.04;

/// Expected value of the rank-th smallest of `count` normal variates of deviation 1, counted from 0 (Blom 1958).
double expected_rank(int rank, int count) noexcept {
  // The quantile of the normal distribution by bisection: once per map.
  const double share = (rank + 1 - 0.375) / (count + 0.25);
  double low = -6.0;
  double high = 6.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < share ? low : high) = middle;
  }
  return low;
}

}  // namespace

NoiseProbe::NoiseProbe(int width, int height)
    : kernels_(focus_kernels()),
      width_(width),
      height_(height),
      columns_(std::max(1, width / kTile_px)),
      rows_(std::max(1, height / kTile_px)),
      least_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNothing),
      sums_(least_.size()) {}

template <typename Pixel>
void NoiseProbe::add_tiles(PlaneView<const Pixel> slice, int tile_row) noexcept {
  const int first = std::max(1, height_ * tile_row / rows_);
  const int end = std::min(height_ - 1, height_ * (tile_row + 1) / rows_);
  std::uint64_t* const sums = sums_.data() + static_cast<std::ptrdiff_t>(tile_row) * columns_;
  std::fill_n(sums, columns_, std::uint64_t{0});
  // Row by row, as the memory lies: the slice comes from far away.
  int rows = 0;
  for (int y = first; y < end; y += kRowStep, ++rows) {
    for (int column = 0; column < columns_; ++column) {
      const int left = tile_left(column);
      const int size = tile_right(column) - left;
      if (size < 3) continue;
      if constexpr (sizeof(Pixel) == 1) {
        sums[column] += kernels_.noise_u8(slice.row(y - 1) + left, slice.row(y) + left, slice.row(y + 1) + left, size);
      } else {
        sums[column] += kernels_.noise_u16(slice.row(y - 1) + left, slice.row(y) + left, slice.row(y + 1) + left, size);
      }
    }
  }
  for (int column = 0; column < columns_; ++column) {
    const int values = rows * (tile_right(column) - tile_left(column) - 2);
    if (values <= 0) continue;
    double mean = static_cast<double>(sums[column]) / static_cast<double>(values);
    for (double& least : least_[tile_index(column, tile_row)]) {
      if (mean < least) std::swap(mean, least);
    }
  }
}

int NoiseProbe::tile_left(int column) const noexcept { return std::max(0, width_ * column / columns_ - 1); }
int NoiseProbe::tile_right(int column) const noexcept { return std::min(width_, width_ * (column + 1) / columns_ + 1); }

void NoiseProbe::add(const ImageView& slice, WorkerPool& pool) noexcept {
  const auto look = [&](int tile_row) {
    if (slice.format == PixelFormat::kMono8) {
      add_tiles(slice.as<std::uint8_t>(), tile_row);
    } else {
      add_tiles(slice.as<std::uint16_t>(), tile_row);
    }
  };
  pool.run(rows_, std::ref(look));
  ++slices_;
}

int NoiseProbe::rank() const noexcept {
  if (slices_ >= kSlicesForThird) return 2;
  return slices_ >= kSlicesForSecond ? 1 : 0;
}

double NoiseProbe::bias() const noexcept {
  return 1.0 + kMeanError * expected_rank(rank(), std::max(rank() + 1, slices_ / 2));
}

float NoiseProbe::sigma(int column, int tile_row) const noexcept {
  const double least = least_[tile_index(column, tile_row)][static_cast<std::size_t>(rank())];
  if (!std::isfinite(least)) return static_cast<float>(kRounding);  // too small an image to see noise in
  return static_cast<float>(std::max(kRounding, std::sqrt(std::numbers::pi / 2) / 6.0 * least / bias()));
}

int NoiseProbe::tile_row(int y) const noexcept {
  int tile_row = 0;
  while (y >= height_ * (tile_row + 1) / rows_) ++tile_row;
  return tile_row;
}

void NoiseProbe::noise_row(int tile_row, float* out) const noexcept {
  for (int column = 0; column < columns_; ++column) {
    std::fill(out + width_ * column / columns_, out + width_ * (column + 1) / columns_, sigma(column, tile_row));
  }
}

std::vector<float> NoiseProbe::sigmas() const {
  std::vector<float> sigmas;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) sigmas.push_back(sigma(column, row));
  }
  return sigmas;
}

double NoiseProbe::median() const {
  std::vector<float> values = sigmas();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

double NoiseProbe::least() const {
  const std::vector<float> values = sigmas();
  return static_cast<double>(*std::min_element(values.begin(), values.end()));
}

}  // namespace fvd
