#pragma once

/// A quadratic surface through the weighted heights about one point, from their sums.

#include <array>
#include <cstddef>
#include <optional>

namespace fvd {

/// u^i v^j of an offset: u along the row, v down the columns, both in standard deviations of the weights.
struct LocalTerm {
  int u;
  int v;
};
inline constexpr std::size_t kLocalUnknowns = 6;  ///< 1, u, v, u^2, u v, v^2: the first six products
/// What the fit needs sums of over points; over heights, of the first six.
inline constexpr std::array<LocalTerm, 15> kLocalProducts{{{0, 0},
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
using LocalTerms = std::array<double, kLocalUnknowns>;

/// About one point: of its neighbours, weighted, by powers of their offsets.
struct LocalSums {
  std::array<double, kLocalProducts.size()> points{};
  LocalTerms heights{};    ///< um
  double squares = 0.0;    ///< of heights, um^2
  double variances = 0.0;  ///< um^2

  /// One neighbour. height and its standard error: um.
  void add(const LocalTerms& terms, double height, double sigma, double weight) noexcept;
};

struct LocalFit {
  LocalTerms surface{};   ///< um
  double squares = 0.0;   ///< sum of the squared weights of the estimate at the point
  double variance = 0.0;  ///< of the points used, mean, um^2
  double scatter = 0.0;   ///< of the points used about the quadratic, mean square, um^2
};

/// For Gaussian weights. context: immutable.
class LocalQuadratic {
 public:
  /// sigma_px, radius_px: of the weights; correlated_px: area over which the errors of heights are one, px^2, >= 1.
  LocalQuadratic(double sigma_px, int radius_px, double correlated_px);

  /// samples_apart: px. Nothing where the neighbours do not hold a quadratic.
  [[nodiscard]] std::optional<LocalFit> fit(const LocalSums& sums, int samples_apart) const;

  /// Variance of the estimate over that of a point. Errors that are one over an area pass where the weights spread no
  /// further: for Gaussian weights and correlations both areas add up.
  [[nodiscard]] double variance_factor(double squares, int samples_apart) const noexcept;

 private:
  [[nodiscard]] double correlated_samples(int samples_apart) const noexcept;  // whose errors are one

  double correlated_px_;
  double full_squares_ = 1.0;         // with all neighbours
  double squares_over_factor_ = 1.0;  // that over the variance factor of the weighted fit
};

}  // namespace fvd
