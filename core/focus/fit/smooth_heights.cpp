#include "core/focus/fit/smooth_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/focus/fit/local_quadratic.hpp"

namespace fvd {

namespace {

/// Weights beyond so many standard deviations are left out: 1 % of the largest.
constexpr double kReach = 3.0;

/// Heights that scatter about their quadratic by more than so many of their standard errors (squared) are more than one
/// surface, and are fitted a second time point by point.
constexpr double kMostScatter = 4.0;
/// There, what is off the quadratic of the nearby heights by more than so many standard errors takes no part.
constexpr double kMostErrors = 6.0;
/// Every n-th pixel does for such a fit, so many to a standard deviation of the weights.
constexpr double kSamplesPerSigma = 3.0;

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
        stride_(std::max(1, static_cast<int>(settings.sigma_px / kSamplesPerSigma))),
        sigma_px_(settings.sigma_px),
        quadratic_(settings.sigma_px, radius_, settings.correlated_px),
        jump_um_(settings.jump_um) {
    for (int offset = -radius_; offset <= radius_; ++offset) {
      const double u = offset / settings.sigma_px;
      double value = std::exp(-0.5 * u * u);
      for (auto& power : taps_) {
        power.push_back(value);
        value *= u;
      }
    }
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
          points(kLocalProducts.size() * static_cast<std::size_t>(s.width_)),
          heights((kLocalUnknowns + 2) * static_cast<std::size_t>(s.width_)) {}
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
      for (std::size_t i = 0; i < kLocalProducts.size(); ++i) {
        const LocalTerm term = kLocalProducts[i];
        add_row(row_sum(band, at, term.u), taps_[static_cast<std::size_t>(term.v)][tap], to(band.points, i));
      }
      for (std::size_t i = 0; i < kLocalUnknowns; ++i) {
        const LocalTerm term = kLocalProducts[i];
        add_row(row_sum(band, at, kPointSums + term.u), taps_[static_cast<std::size_t>(term.v)][tap],
                to(band.heights, i));
      }
      add_row(row_sum(band, at, kSquares), taps_[0][tap], to(band.heights, kLocalUnknowns));
      add_row(row_sum(band, at, kVariances), taps_[0][tap], to(band.heights, kLocalUnknowns + 1));
    }
  }

  void solve(const Band& band, int x, int y) const {
    float& height_out = out_.height_m.at(x, y);
    float& sigma_out = out_.sigma_m.at(x, y);
    height_out = height_m_.at(x, y);
    sigma_out = sigma_m_.at(x, y);
    if (std::isnan(height_out)) return;
    const auto at = [&](const std::vector<double>& sums, std::size_t i) {
      return sums[i * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    };
    LocalSums sums;
    for (std::size_t i = 0; i < sums.points.size(); ++i) sums.points[i] = at(band.points, i);
    for (std::size_t i = 0; i < kLocalUnknowns; ++i) sums.heights[i] = at(band.heights, i);
    sums.squares = at(band.heights, kLocalUnknowns);
    sums.variances = at(band.heights, kLocalUnknowns + 1);
    std::optional<LocalFit> fit = quadratic_.fit(sums, 1);
    if (!fit) return;
    int samples_apart = 1;
    double height_um = 0.0;
    if (fit->scatter > kMostScatter * fit->variance) {
      samples_apart = stride_;
      height_um = 1e6 * static_cast<double>(height_out);
      fit = fitted_on_one_side(x, y);
    }
    if (!fit) return;
    height_um += fit->surface[0];
    height_out = static_cast<float>(height_um * 1e-6);
    sigma_out = static_cast<float>(1e-6 * std::sqrt(std::max(fit->variance, fit->scatter) *
                                                    quadratic_.variance_factor(fit->squares, samples_apart)));
  }

  /// Of the neighbours that lie on the point's own side of a wall, heights relative to the point's: first of those that
  /// are about as high, then of all that lie on that surface.
  [[nodiscard]] std::optional<LocalFit> fitted_on_one_side(int x, int y) const {
    const std::optional<LocalFit> near = quadratic_.fit(
        sums_about(x, y, [this](double height, const LocalTerms&) { return std::abs(height) <= jump_um_; }), stride_);
    if (!near) return std::nullopt;
    const double most = std::min(jump_um_, kMostErrors * std::sqrt(std::max(near->variance, near->scatter)));
    return quadratic_.fit(sums_about(x, y,
                                     [&](double height, const LocalTerms& terms) {
                                       return std::abs(height - std::inner_product(terms.begin(), terms.end(),
                                                                                   near->surface.begin(), 0.0)) <= most;
                                     }),
                          stride_);
  }

  /// takes_part(height, terms): of a neighbour, um above the point, and its offset's terms.
  template <typename TakesPart>
  [[nodiscard]] LocalSums sums_about(int x, int y, const TakesPart& takes_part) const {
    LocalSums sums;
    const float middle = height_m_.at(x, y);
    const int reach = radius_ / stride_ * stride_;
    for (int v = -reach; v <= reach; v += stride_) {
      if (y + v < 0 || y + v >= height_) continue;
      const float* const heights = height_m_.row(y + v) + x;
      const float* const sigmas = sigma_m_.row(y + v) + x;
      for (int u = -reach; u <= reach; u += stride_) {
        if (x + u < 0 || x + u >= width_ || std::isnan(heights[u])) continue;
        const double height = 1e6 * (static_cast<double>(heights[u]) - static_cast<double>(middle));
        const double along = u / sigma_px_;
        const double down = v / sigma_px_;
        const LocalTerms terms{1.0, along, down, along * along, along * down, down * down};
        if (!takes_part(height, terms)) continue;
        sums.add(terms, height, 1e6 * static_cast<double>(sigmas[u]),
                 taps_[0][static_cast<std::size_t>(u + radius_)] * taps_[0][static_cast<std::size_t>(v + radius_)]);
      }
    }
    return sums;
  }

  const Plane<float>& height_m_;
  const Plane<float>& sigma_m_;
  SmoothedHeights& out_;
  int width_;
  int height_;
  int radius_;
  int stride_;  // px, of the fits point by point
  double sigma_px_;
  LocalQuadratic quadratic_;
  double jump_um_;
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
  if (!(settings.jump_um > 0.0)) {
    throw Error(ErrorCode::kBadInput, "jumps of " + std::to_string(settings.jump_um) + " um: must be above 0 um");
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
