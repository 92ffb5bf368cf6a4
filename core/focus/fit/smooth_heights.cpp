#include "core/focus/fit/smooth_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/base/error.hpp"

namespace fvd {

namespace {

/// Weights beyond so many standard deviations are left out: 1 % of the largest.
constexpr double kReach = 3.0;

/// A fit whose variance is more than so many times that of a point is one that its neighbours do not hold: at the end
/// of a strip, or where nearly all of them are holes.
constexpr double kLargestFactor = 4.0;

/// Along one direction: weight times the offset to the powers 0..4. Offsets are in sigma, so that all powers are of one
/// size.
constexpr int kPowers = 5;
using Taps = std::array<std::vector<double>, kPowers>;

/// Sums that a row keeps per column: of valid points u^0..4, of heights u^0..2, of squared heights and variances.
constexpr int kPointSums = 5;
constexpr int kHeightSums = 3;
constexpr int kRowSums = kPointSums + kHeightSums + 2;
constexpr int kSquares = kPointSums + kHeightSums;
constexpr int kVariances = kSquares + 1;

/// What the solver gets per column: sums of u^i v^j over points, i + j <= 4, and over heights, i + j <= 2.
struct Term {
  int u;
  int v;
};
constexpr std::array<Term, 15> kPointTerms{{{0, 0},
                                            {1, 0},
                                            {0, 1},
                                            {2, 0},
                                            {1, 1},
                                            {0, 2},
                                            {3, 0},
                                            {2, 1},
                                            {1, 2},
                                            {0, 3},
                                            {4, 0},
                                            {3, 1},
                                            {2, 2},
                                            {1, 3},
                                            {0, 4}}};
constexpr int kUnknowns = 6;  // 1, u, v, u^2, u v, v^2: the first six terms

constexpr int term_index(int u, int v) {
  for (std::size_t i = 0; i < kPointTerms.size(); ++i) {
    if (kPointTerms[i].u == u && kPointTerms[i].v == v) return static_cast<int>(i);
  }
  return -1;
}

class Smoother {
 public:
  Smoother(const Plane<float>& height_m, const Plane<float>& sigma_m, const SmoothSettings& settings,
           SmoothedHeights& out)
      : height_m_(height_m),
        sigma_m_(sigma_m),
        out_(out),
        width_(height_m.width()),
        height_(height_m.height()),
        radius_(static_cast<int>(std::ceil(kReach * settings.sigma_px))),
        correlated_px_(settings.correlated_px) {
    for (int offset = -radius_; offset <= radius_; ++offset) {
      const double u = offset / settings.sigma_px;
      double value = std::exp(-0.5 * u * u);
      for (auto& power : taps_) {
        power.push_back(value);
        value *= u;
      }
    }
    // With all neighbours: the sum of the squared weights of the estimate over the variance factor of the weighted fit.
    squares_over_factor_ = full_squares_over_factor();
  }

  /// Rows first .. end - 1.
  void run(int first, int end) const {
    Band band(*this);
    for (int y = first; y < end; ++y) {
      for (int row = std::max(0, y - radius_); row <= std::min(height_ - 1, y + radius_); ++row) {
        if (band.row_of_slot[slot(row)] != row) fill(band, row);
      }
      sum_rows(band, y);
      for (int x = 0; x < width_; ++x) solve(band, x, y);
    }
  }

 private:
  struct Band {
    explicit Band(const Smoother& s)
        : row_of_slot(static_cast<std::size_t>(2 * s.radius_ + 1), -1),
          rows(row_of_slot.size() * kRowSums * static_cast<std::size_t>(s.width_)),
          padded((4 + 1) * static_cast<std::size_t>(s.width_ + 2 * s.radius_)),
          points(kPointTerms.size() * static_cast<std::size_t>(s.width_)),
          heights((kUnknowns + 2) * static_cast<std::size_t>(s.width_)) {}
    std::vector<int> row_of_slot;
    std::vector<double> rows;     // [slot][sum][width]
    std::vector<double> padded;   // [valid, height, square, variance][width + 2 radius]
    std::vector<double> points;   // [term][width]
    std::vector<double> heights;  // [unknown, squares, variances][width]
  };

  [[nodiscard]] std::size_t slot(int row) const { return static_cast<std::size_t>(row % (2 * radius_ + 1)); }
  [[nodiscard]] double* row_sum(Band& band, std::size_t slot_number, int sum) const {
    return band.rows.data() +
           (static_cast<std::ptrdiff_t>(slot_number) * kRowSums + sum) * static_cast<std::ptrdiff_t>(width_);
  }

  /// out[x] = sum of taps times values over the columns about x; values have `radius` more at either end.
  void convolve(const double* values, const std::vector<double>& taps, double* out) const {
    std::fill_n(out, width_, 0.0);
    for (std::size_t k = 0; k < taps.size(); ++k) {
      const double tap = taps[k];
      const double* from = values + k;
      for (int x = 0; x < width_; ++x) out[x] += tap * from[x];
    }
  }

  /// The sums along one row.
  void fill(Band& band, int row) const {
    const auto padded_width = static_cast<std::ptrdiff_t>(width_) + 2 * radius_;
    std::fill(band.padded.begin(), band.padded.end(), 0.0);
    double* valid = band.padded.data() + radius_;
    double* value = valid + padded_width;
    double* square = value + padded_width;
    double* variance = square + padded_width;
    const float* heights = height_m_.row(row);
    const float* sigmas = sigma_m_.row(row);
    for (int x = 0; x < width_; ++x) {
      if (std::isnan(heights[x])) continue;
      const double h = static_cast<double>(heights[x]) * 1e6;  // um: numbers near 1
      const double s = static_cast<double>(sigmas[x]) * 1e6;
      valid[x] = 1.0;
      value[x] = h;
      square[x] = h * h;
      variance[x] = s * s;
    }
    const std::size_t at = slot(row);
    for (int i = 0; i < kPointSums; ++i)
      convolve(valid - radius_, taps_[static_cast<std::size_t>(i)], row_sum(band, at, i));
    for (int i = 0; i < kHeightSums; ++i) {
      convolve(value - radius_, taps_[static_cast<std::size_t>(i)], row_sum(band, at, kPointSums + i));
    }
    convolve(square - radius_, taps_[0], row_sum(band, at, kSquares));
    convolve(variance - radius_, taps_[0], row_sum(band, at, kVariances));
    band.row_of_slot[at] = row;
  }

  void add_row(const double* from, double tap, double* to) const {
    for (int x = 0; x < width_; ++x) to[x] += tap * from[x];
  }

  void sum_rows(Band& band, int y) const {
    std::fill(band.points.begin(), band.points.end(), 0.0);
    std::fill(band.heights.begin(), band.heights.end(), 0.0);
    for (int row = std::max(0, y - radius_); row <= std::min(height_ - 1, y + radius_); ++row) {
      const auto tap = static_cast<std::size_t>(row - y + radius_);
      const std::size_t at = slot(row);
      const auto to = [&](std::vector<double>& sums, std::size_t i) {
        return sums.data() + static_cast<std::ptrdiff_t>(i) * width_;
      };
      for (std::size_t i = 0; i < kPointTerms.size(); ++i) {
        const Term term = kPointTerms[i];
        add_row(row_sum(band, at, term.u), taps_[static_cast<std::size_t>(term.v)][tap], to(band.points, i));
      }
      for (std::size_t i = 0; i < kUnknowns; ++i) {
        const Term term = kPointTerms[i];
        add_row(row_sum(band, at, kPointSums + term.u), taps_[static_cast<std::size_t>(term.v)][tap],
                to(band.heights, i));
      }
      add_row(row_sum(band, at, kSquares), taps_[0][tap], to(band.heights, kUnknowns));
      add_row(row_sum(band, at, kVariances), taps_[0][tap], to(band.heights, kUnknowns + 1));
    }
  }

  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  void solve(const Band& band, int x, int y) const {
    float& height_out = out_.height_m.at(x, y);
    float& sigma_out = out_.sigma_m.at(x, y);
    height_out = height_m_.at(x, y);
    sigma_out = sigma_m_.at(x, y);
    if (std::isnan(height_out)) return;
    const auto point = [&](int term) {
      return band
          .points[static_cast<std::size_t>(term) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    };
    const auto height = [&](int term) {
      return band
          .heights[static_cast<std::size_t>(term) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    };
    Matrix normal;
    for (int i = 0; i < kUnknowns; ++i) {
      for (int j = 0; j < kUnknowns; ++j) {
        normal(i, j) = point(kProducts[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
      }
    }
    const Eigen::LLT<Matrix> factor(normal);
    if (factor.info() != Eigen::Success) return;
    const Vector first = factor.solve(Vector::Unit(0));  // its first element: the fit's variance over that of a point
    const double squares = squares_over_factor_ * first(0);
    if (!(squares > 0.0 && squares * correlated_px_ < kLargestFactor)) return;
    Vector sums;
    for (int i = 0; i < kUnknowns; ++i) sums(i) = height(i);
    const Vector fit = factor.solve(sums);
    const double weights = point(0);
    const double scatter = std::max(0.0, (height(kUnknowns) - fit.dot(sums)) / weights);
    const double variance = std::max(height(kUnknowns + 1) / weights, scatter);
    height_out = static_cast<float>(fit(0) * 1e-6);
    sigma_out = static_cast<float>(1e-6 * std::sqrt(variance * squares * correlated_px_));
  }

  /// Sum k^2 over M^-1(0,0) for a neighbourhood without holes, k = M^-1 X^T W of the middle's height.
  [[nodiscard]] double full_squares_over_factor() const {
    Matrix normal = Matrix::Zero();
    Matrix squared = Matrix::Zero();
    for (int v = 0; v < 2 * radius_ + 1; ++v) {
      for (int u = 0; u < 2 * radius_ + 1; ++u) {
        const auto one = [&](const Taps& taps, int power, int at) {
          return taps[static_cast<std::size_t>(power)][static_cast<std::size_t>(at)];
        };
        const double weight = one(taps_, 0, u) * one(taps_, 0, v);
        Vector terms;
        for (int i = 0; i < kUnknowns; ++i) {
          const Term term = kPointTerms[static_cast<std::size_t>(i)];
          terms(i) = one(taps_, term.u, u) * one(taps_, term.v, v) / weight;
        }
        normal += weight * terms * terms.transpose();
        squared += weight * weight * terms * terms.transpose();
      }
    }
    const Vector first = normal.llt().solve(Vector::Unit(0));
    return first.dot(squared * first) / first(0);
  }

  static constexpr std::array<std::array<int, kUnknowns>, kUnknowns> kProducts = [] {
    std::array<std::array<int, kUnknowns>, kUnknowns> products{};
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        products[i][j] = term_index(kPointTerms[i].u + kPointTerms[j].u, kPointTerms[i].v + kPointTerms[j].v);
      }
    }
    return products;
  }();

  const Plane<float>& height_m_;
  const Plane<float>& sigma_m_;
  SmoothedHeights& out_;
  int width_;
  int height_;
  int radius_;
  double correlated_px_;
  double squares_over_factor_ = 1.0;
  Taps taps_;
};

}  // namespace

SmoothedHeights smooth_heights(const Plane<float>& height_m, const Plane<float>& sigma_m,
                               const SmoothSettings& settings, WorkerPool& pool) {
  if (!(settings.sigma_px >= kMinSmoothPx && settings.sigma_px <= kMaxSmoothPx)) {
    throw Error(ErrorCode::kBadInput,
                "smoothing over " + std::to_string(settings.sigma_px) + " px: must be within 1..16 px");
  }
  if (!(settings.correlated_px >= 1.0)) {
    throw Error(ErrorCode::kBadInput,
                "errors correlated over " + std::to_string(settings.correlated_px) + " px^2: must be at least 1 px^2");
  }
  const int width = height_m.width();
  const int height = height_m.height();
  SmoothedHeights out{Plane<float>::unset(width, height), Plane<float>::unset(width, height)};
  const int bands = pool.threads();
  pool.run(bands, [&](int band) {
    const Smoother smoother(height_m, sigma_m, settings, out);
    smoother.run(height * band / bands, height * (band + 1) / bands);
  });
  return out;
}

}  // namespace fvd
