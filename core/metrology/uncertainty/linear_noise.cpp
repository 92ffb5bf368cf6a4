#include "core/metrology/uncertainty/linear_noise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace fvd::metrology {
namespace {

/// Rows of weight * sigma, averaged along x and then along y by the kernel, one output row after the other. Only as
/// many rows are held as the kernel has.
class AveragedRows {
 public:
  AveragedRows(const HeightField& field, const WeightMap& map)
      : field_(field),
        map_(map),
        reach_(field.kernel.reach_px()),
        padded_(static_cast<std::size_t>(map.weights.width() + 4 * reach_)),
        ring_(field.kernel.weights.size(), std::vector<double>(width())),
        row_(width()) {}

  [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(map_.weights.width() + 2 * reach_); }
  [[nodiscard]] const std::vector<double>& row() const { return row_; }
  [[nodiscard]] double independent() const { return independent_; }  // sum of (w sigma)^2 of the rows seen

  /// The output row that is y rows below the map's first; y = -reach, -reach + 1, ... in this order. It is the mean
  /// over the rows y - reach .. y + reach, of which y + reach is new.
  void advance(int y) {
    take(y + reach_);
    std::fill(row_.begin(), row_.end(), 0.0);
    const auto taps = static_cast<int>(ring_.size());
    for (int tap = 0; tap < taps; ++tap) {
      const int source = y - reach_ + tap;
      if (source < 0 || source >= map_.weights.height()) continue;
      const double weight = field_.kernel.weights[static_cast<std::size_t>(tap)];
      const std::vector<double>& values = slot(source);
      for (std::size_t x = 0; x < row_.size(); ++x) row_[x] += weight * values[x];
    }
  }

 private:
  std::vector<double>& slot(int y) { return ring_[static_cast<std::size_t>(y) % ring_.size()]; }

  void take(int y) {
    if (y < 0 || y >= map_.weights.height()) return;
    const double* weights = map_.weights.row(y);
    const float* sigma = field_.sigma_um.row(map_.top + y) + map_.left;
    double* scaled = padded_.data() + 2 * reach_;
    for (int x = 0; x < map_.weights.width(); ++x) {
      // A hole's sigma is NaN; what has no weight does not count.
      scaled[x] = weights[x] == 0.0 ? 0.0 : weights[x] * static_cast<double>(sigma[x]);
      assert(!std::isnan(scaled[x]));
      independent_ += scaled[x] * scaled[x];
    }
    std::vector<double>& values = slot(y);
    std::fill(values.begin(), values.end(), 0.0);
    for (std::size_t tap = 0; tap < ring_.size(); ++tap) {
      const double weight = field_.kernel.weights[tap];
      const double* source = padded_.data() + tap;
      for (std::size_t x = 0; x < values.size(); ++x) values[x] += weight * source[x];
    }
  }

  const HeightField& field_;
  const WeightMap& map_;
  int reach_;
  std::vector<double> padded_;             // one row with zeros of twice the reach on both sides
  std::vector<std::vector<double>> ring_;  // rows averaged along x
  std::vector<double> row_;
  double independent_ = 0.0;
};

/// Sum of the squares of the two-dimensional kernel.
double squares_of(const LateralKernel& kernel) {
  const double along = 1.0 / kernel.width_px();
  return along * along;
}

void check(const HeightField& field, const WeightMap& map) {
  assert(map.left >= 0 && map.top >= 0);
  assert(map.left + map.weights.width() <= field.width() && map.top + map.weights.height() <= field.height());
  assert(field.kernel.weights.size() % 2 == 1);
}

/// sum of a[x] b[x] over both rows, which may begin at different columns of the field.
double overlap_product(const AveragedRows& a, int a_left, const AveragedRows& b, int b_left) {
  const int from = std::max(a_left, b_left);
  const int to = std::min(a_left + static_cast<int>(a.width()), b_left + static_cast<int>(b.width()));
  double sum = 0.0;
  for (int x = from; x < to; ++x) {
    sum += a.row()[static_cast<std::size_t>(x - a_left)] * b.row()[static_cast<std::size_t>(x - b_left)];
  }
  return sum;
}

}  // namespace

std::optional<LinearNoise> linear_noise(const HeightField& field, const WeightMap& map) {
  if (!field.has_sigma()) return std::nullopt;
  check(field, map);
  AveragedRows rows(field, map);
  const int reach = field.kernel.reach_px();
  double sum = 0.0;
  for (int y = -reach; y < map.weights.height() + reach; ++y) {
    rows.advance(y);
    double of_row = 0.0;
    for (const double value : rows.row()) of_row += value * value;
    sum += of_row;
  }
  const double variance = sum / squares_of(field.kernel);
  return LinearNoise{std::sqrt(variance), rows.independent() > 0.0 ? variance / rows.independent() : 1.0};
}

std::optional<std::vector<double>> linear_covariance(const HeightField& field, std::span<const WeightMap* const> maps) {
  assert(!maps.empty());
  if (!field.has_sigma()) return std::nullopt;
  const int reach = field.kernel.reach_px();
  std::vector<AveragedRows> rows;
  rows.reserve(maps.size());
  int from = field.height();
  int to = 0;
  for (const WeightMap* map : maps) {
    check(field, *map);
    rows.emplace_back(field, *map);
    from = std::min(from, map->top - reach);
    to = std::max(to, map->top + map->weights.height() + reach);
  }
  const auto inside = [&](std::size_t i, int y) {
    return y >= maps[i]->top - reach && y < maps[i]->top + maps[i]->weights.height() + reach;
  };
  const std::size_t n = maps.size();
  std::vector<double> covariance(n * n, 0.0);
  for (int y = from; y < to; ++y) {
    for (std::size_t i = 0; i < n; ++i) {
      if (inside(i, y)) rows[i].advance(y - maps[i]->top);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i; j < n && inside(i, y); ++j) {
        if (!inside(j, y)) continue;
        covariance[i * n + j] += overlap_product(rows[i], maps[i]->left - reach, rows[j], maps[j]->left - reach);
      }
    }
  }
  const double squares = squares_of(field.kernel);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      covariance[i * n + j] /= squares;
      covariance[j * n + i] = covariance[i * n + j];
    }
  }
  return covariance;
}

void set_uniform_sigma(HeightField& field, double sigma_um) {
  assert(sigma_um > 0.0 && std::isfinite(sigma_um));
  field.sigma_um = Plane<float>(field.width(), field.height(), std::nanf(""));
  const std::span<const double> z = static_cast<const Plane<double>&>(field.z_um).pixels();
  const std::span<float> sigma = field.sigma_um.pixels();
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!std::isnan(z[i])) sigma[i] = static_cast<float>(sigma_um);
  }
}

}  // namespace fvd::metrology
