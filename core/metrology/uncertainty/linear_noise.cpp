#include "core/metrology/uncertainty/linear_noise.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>

namespace fvd::metrology {
namespace {

constexpr std::size_t kLanes = 8;
/// Each band also averages the rows of the kernel's reach above and below it.
constexpr int kBandRows = 128;

double sum_of_squares(std::span<const double> values) {
  std::array<double, kLanes> squares{};
  std::size_t x = 0;
  for (; x + kLanes <= values.size(); x += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) squares[lane] += values[x + lane] * values[x + lane];
  }
  double sum = 0.0;
  for (; x < values.size(); ++x) sum += values[x] * values[x];
  for (const double square : squares) sum += square;
  return sum;
}

/// sum of kernel[tap] * source(tap)[x] for each x, from the first tap to the last.
template <typename Source>
void weighted_sum(const std::vector<double>& kernel, const Source& source, std::vector<double>& sums) {
  std::size_t x = 0;
  for (; x + kLanes <= sums.size(); x += kLanes) {
    std::array<double, kLanes> here{};
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const double* from = source(tap);
      if (from == nullptr) continue;
      for (std::size_t lane = 0; lane < kLanes; ++lane) here[lane] += kernel[tap] * from[x + lane];
    }
    std::copy(here.begin(), here.end(), sums.data() + x);
  }
  for (; x < sums.size(); ++x) {
    double here = 0.0;
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const double* from = source(tap);
      if (from != nullptr) here += kernel[tap] * from[x];
    }
    sums[x] = here;
  }
}

/// Rows of weight * sigma, averaged along x and then along y by the kernel, one output row after the other. Only as
/// many rows are held as the kernel has.
class AveragedRows {
 public:
  /// first: the output row that advance() is first called for, of -reach, -reach + 1, ...; the output row y is y rows
  /// below the map's first.
  AveragedRows(const HeightField& field, const WeightMap& map, int first)
      : field_(field),
        map_(map),
        reach_(field.kernel.reach_px()),
        padded_(static_cast<std::size_t>(map.weights.width() + 4 * reach_)),
        ring_(field.kernel.weights.size(), std::vector<double>(width())),
        is_zero_(field.kernel.weights.size(), true),
        row_(width()) {
    for (int y = first - reach_; y < first + reach_; ++y) take(y);
    independent_ = 0.0;
  }

  [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(map_.weights.width() + 2 * reach_); }
  [[nodiscard]] const std::vector<double>& row() const { return row_; }
  /// Sum of (w sigma)^2 of the row that advance() took last.
  [[nodiscard]] double independent() const { return independent_; }

  /// The mean over the rows y - reach .. y + reach, of which y + reach is new. Called for one row after the other.
  void advance(int y) {
    take(y + reach_);
    const int rows = map_.weights.height();
    weighted_sum(
        field_.kernel.weights,
        [&](std::size_t tap) -> const double* {
          const int source = y - reach_ + static_cast<int>(tap);
          return source < 0 || source >= rows || is_zero_[slot(source)] ? nullptr : ring_[slot(source)].data();
        },
        row_);
  }

 private:
  [[nodiscard]] std::size_t slot(int y) const { return static_cast<std::size_t>(y) % ring_.size(); }

  void take(int y) {
    independent_ = 0.0;
    if (y < 0 || y >= map_.weights.height()) return;
    const double* weights = map_.weights.row(y);
    const float* sigma = field_.sigma_um.row(map_.top + y) + map_.left;
    double* scaled = padded_.data() + 2 * reach_;
    for (int x = 0; x < map_.weights.width(); ++x) {
      // A hole's sigma is NaN; what has no weight does not count.
      scaled[x] = weights[x] == 0.0 ? 0.0 : weights[x] * static_cast<double>(sigma[x]);
    }
    independent_ = sum_of_squares({scaled, static_cast<std::size_t>(map_.weights.width())});
    assert(!std::isnan(independent_));
    is_zero_[slot(y)] = independent_ == 0.0;
    if (is_zero_[slot(y)]) return;
    weighted_sum(
        field_.kernel.weights, [&](std::size_t tap) -> const double* { return padded_.data() + tap; }, ring_[slot(y)]);
  }

  const HeightField& field_;
  const WeightMap& map_;
  int reach_;
  std::vector<double> padded_;             // one row with zeros of twice the reach on both sides
  std::vector<std::vector<double>> ring_;  // rows averaged along x
  std::vector<char> is_zero_;              // of the ring: rows without a weight, which are not averaged
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

std::optional<LinearNoise> linear_noise(const HeightField& field, const WeightMap& map, WorkerPool* pool) {
  if (!field.has_sigma()) return std::nullopt;
  check(field, map);
  const int reach = field.kernel.reach_px();
  const int rows = map.weights.height() + 2 * reach;
  struct RowSums {
    double averaged = 0.0;
    double independent = 0.0;
  };
  std::vector<RowSums> of_rows(static_cast<std::size_t>(rows));
  const auto one_band = [&](int band) {
    const int first = band * kBandRows;
    AveragedRows averaged(field, map, first - reach);
    for (int row = first; row < std::min(first + kBandRows, rows); ++row) {
      averaged.advance(row - reach);
      RowSums& sums = of_rows[static_cast<std::size_t>(row)];
      sums.independent = averaged.independent();
      sums.averaged = sum_of_squares(averaged.row());
    }
  };
  const int bands = (rows + kBandRows - 1) / kBandRows;
  if (pool != nullptr) {
    pool->run(bands, std::ref(one_band));
  } else {
    for (int band = 0; band < bands; ++band) one_band(band);
  }
  // Row by row, whatever thread had them.
  double sum = 0.0;
  double independent = 0.0;
  for (const RowSums& sums : of_rows) {
    sum += sums.averaged;
    independent += sums.independent;
  }
  const double variance = sum / squares_of(field.kernel);
  return LinearNoise{std::sqrt(variance), independent > 0.0 ? variance / independent : 1.0};
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
    rows.emplace_back(field, *map, -reach);
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
