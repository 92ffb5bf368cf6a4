#include "core/focus/fit/local_quadratic.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace fvd {

namespace {

/// A fit whose variance is more than so many times that of a point, and so many times that with all neighbours (which
/// weights narrower than a window make more of), is one that its neighbours do not hold: at the end of a strip, or
/// where nearly all of them are holes.
constexpr double kMostOverPoint = 4.0;
constexpr double kMostOverAll = 2.0;

using Matrix = Eigen::Matrix<double, static_cast<int>(kLocalUnknowns), static_cast<int>(kLocalUnknowns)>;
using Vector = Eigen::Matrix<double, static_cast<int>(kLocalUnknowns), 1>;

constexpr std::size_t product_index(int u, int v) {
  for (std::size_t i = 0; i < kLocalProducts.size(); ++i) {
    if (kLocalProducts[i].u == u && kLocalProducts[i].v == v) return i;
  }
  return kLocalProducts.size();
}

/// Of the products of two terms.
constexpr auto kProductOf = [] {
  std::array<std::array<std::size_t, kLocalUnknowns>, kLocalUnknowns> products{};
  for (std::size_t i = 0; i < kLocalUnknowns; ++i) {
    for (std::size_t j = 0; j < kLocalUnknowns; ++j) {
      products[i][j] =
          product_index(kLocalProducts[i].u + kLocalProducts[j].u, kLocalProducts[i].v + kLocalProducts[j].v);
    }
  }
  return products;
}();

}  // namespace

void LocalSums::add(const LocalTerms& terms, double height, double sigma, double weight) noexcept {
  const double along2 = weight * terms[3];
  const double down2 = weight * terms[5];
  for (std::size_t i = 0; i < kLocalUnknowns; ++i) {
    points[i] += weight * terms[i];
    heights[i] += weight * terms[i] * height;
  }
  points[6] += along2 * terms[1];
  points[7] += along2 * terms[2];
  points[8] += down2 * terms[1];
  points[9] += down2 * terms[2];
  points[10] += along2 * terms[3];
  points[11] += along2 * terms[4];
  points[12] += along2 * terms[5];
  points[13] += down2 * terms[4];
  points[14] += down2 * terms[5];
  squares += weight * height * height;
  variances += weight * sigma * sigma;
}

LocalQuadratic::LocalQuadratic(double sigma_px, int radius_px, double correlated_px) : correlated_px_(correlated_px) {
  // k = M^-1 X^T W are the weights of the middle's height.
  Matrix normal = Matrix::Zero();
  Matrix squared = Matrix::Zero();
  for (int y = -radius_px; y <= radius_px; ++y) {
    for (int x = -radius_px; x <= radius_px; ++x) {
      const double u = x / sigma_px;
      const double v = y / sigma_px;
      const double weight = std::exp(-0.5 * (u * u + v * v));
      const Vector terms{{1.0, u, v, u * u, u * v, v * v}};
      normal += weight * terms * terms.transpose();
      squared += weight * weight * terms * terms.transpose();
    }
  }
  const Vector first = normal.llt().solve(Vector::Unit(0));
  full_squares_ = first.dot(squared * first);
  squares_over_factor_ = full_squares_ / first(0);
}

std::optional<LocalFit> LocalQuadratic::fit(const LocalSums& sums, int samples_apart) const {
  Matrix normal;
  for (std::size_t i = 0; i < kLocalUnknowns; ++i) {
    for (std::size_t j = 0; j < kLocalUnknowns; ++j) {
      normal(static_cast<int>(i), static_cast<int>(j)) = sums.points[kProductOf[i][j]];
    }
  }
  const Eigen::LLT<Matrix> factor(normal);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Vector first = factor.solve(Vector::Unit(0));  // its first element: the fit's variance over that of a point
  LocalFit fit;
  fit.squares = squares_over_factor_ * first(0);
  const double all = full_squares_ * samples_apart * samples_apart;
  const double point = 1.0 / correlated_samples(samples_apart);
  if (!(fit.squares > 0.0 && fit.squares < std::max(kMostOverAll * all, kMostOverPoint * point))) return std::nullopt;
  const Eigen::Map<const Vector> heights(sums.heights.data());
  const Vector surface = factor.solve(heights);
  std::copy_n(surface.data(), kLocalUnknowns, fit.surface.data());
  fit.variance = sums.variances / sums.points[0];
  fit.scatter = std::max(0.0, (sums.squares - surface.dot(heights)) / sums.points[0]);
  return fit;
}

double LocalQuadratic::correlated_samples(int samples_apart) const noexcept {
  return std::max(1.0, correlated_px_ / (samples_apart * samples_apart));
}

double LocalQuadratic::variance_factor(double squares, int samples_apart) const noexcept {
  const double correlated = correlated_samples(samples_apart);
  const double independent = squares * correlated;
  return independent / (1.0 + independent * (1.0 - 1.0 / correlated));
}

}  // namespace fvd
