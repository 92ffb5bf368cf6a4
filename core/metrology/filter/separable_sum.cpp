#include "core/metrology/filter/separable_sum.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace fvd::metrology {
namespace {

constexpr int kRowsOfALane = 16;

/// One row, the neighbours beyond its ends 0. padded: memory of width + 2 * reach.
void sum_along_row(const double* source, int width, const std::vector<double>& half, std::vector<double>& padded,
                   double* result) {
  const std::size_t reach = half.size() - 1;
  std::fill(padded.begin(), padded.end(), 0.0);
  std::copy_n(source, width, padded.data() + reach);
  const auto count = static_cast<std::size_t>(width);
  const double* middle = padded.data() + reach;
  for (std::size_t x = 0; x < count; ++x) result[x] = half[0] * middle[x];
  for (std::size_t d = 1; d <= reach; ++d) {
    const double weight = half[d];
    const double* left = middle - d;
    const double* right = middle + d;
    for (std::size_t x = 0; x < count; ++x) result[x] += weight * (left[x] + right[x]);
  }
}

void add_row(const Plane<double>& source, int y, double weight, double* result) {
  if (y < 0 || y >= source.height()) return;
  const double* row = source.row(y);
  for (int x = 0; x < source.width(); ++x) result[x] += weight * row[x];
}

Plane<double> sum_directly(const Plane<double>& source, const SeparableKernel& kernel, WorkerPool* pool) {
  const int width = source.width();
  const int height = source.height();
  const int lanes = (height + kRowsOfALane - 1) / kRowsOfALane;
  auto along = Plane<double>::unset(width, height);
  const auto rows = [&](int lane) {
    std::vector<double> padded(static_cast<std::size_t>(width) + 2 * (kernel.half_x.size() - 1));
    for (int y = lane * kRowsOfALane; y < std::min((lane + 1) * kRowsOfALane, height); ++y) {
      sum_along_row(source.row(y), width, kernel.half_x, padded, along.row(y));
    }
  };
  run_lanes(pool, lanes, std::ref(rows));
  Plane<double> result(width, height);
  const auto reach = static_cast<int>(kernel.half_y.size()) - 1;
  const auto columns = [&](int lane) {
    for (int y = lane * kRowsOfALane; y < std::min((lane + 1) * kRowsOfALane, height); ++y) {
      for (int d = -reach; d <= reach; ++d) {
        add_row(along, y + d, kernel.half_y[static_cast<std::size_t>(d < 0 ? -d : d)], result.row(y));
      }
    }
  };
  run_lanes(pool, lanes, std::ref(columns));
  return result;
}

}  // namespace

Plane<double> separable_sum(const Plane<double>& source, const SeparableKernel& kernel, WorkerPool* pool) {
  if (kernel.half_x.size() + kernel.half_y.size() <= static_cast<std::size_t>(kLongReachPx) + 2) {
    return sum_directly(source, kernel, pool);
  }
  MomentRows moments(source.width(), source.height(), kernel, 0, 1, pool);
  auto result = Plane<double>::unset(source.width(), source.height());
  for (int band = 0; band < moments.bands(); ++band) {
    const MomentRows::Band loaded = moments.load(source, band, 0);
    moments.each_row(band, [&](int lane, int y) { moments.sum_row(loaded, y, {0, 0}, lane, result.row(y)); });
  }
  return result;
}

}  // namespace fvd::metrology
