#pragma once

/// The constant term of a weighted polynomial fit, from its moments.

#include <array>
#include <cstddef>
#include <optional>

namespace fvd::metrology {

/// Smallest pivot that still determines a coefficient, of the coefficient's own moment and of the whole kernel's
/// weight: moments come from Fourier transforms with errors of 1e-15 of that weight.
inline constexpr double kMinRelativePivot = 1e-7;
inline constexpr double kMinPivot = 1e-8;

/// Normal equations of N coefficients, the constant as the last one: matrix (lower triangle) and right hand side.
template <std::size_t N>
struct LocalMoments {
  std::array<std::array<double, N>, N> matrix;
  std::array<double, N> right;
};

/// Value of the polynomial in the middle, where all terms but the constant are 0; absent where the points do not
/// determine it. Elimination without exchange (the matrix is positive) in the order of the coefficients, so that the
/// last row needs no substitution. The moments are used up.
template <std::size_t N>
[[nodiscard]] std::optional<double> constant_term(LocalMoments<N>& moments) {
  auto& a = moments.matrix;
  auto& b = moments.right;
  std::array<double, N> own{};
  for (std::size_t k = 0; k < N; ++k) own[k] = a[k][k];
  for (std::size_t k = 0; k < N; ++k) {
    const double pivot = a[k][k];
    if (!(pivot > kMinPivot) || !(pivot > kMinRelativePivot * own[k])) return std::nullopt;
    for (std::size_t i = k + 1; i < N; ++i) {
      const double factor = a[i][k] / pivot;
      for (std::size_t j = k + 1; j <= i; ++j) a[i][j] -= factor * a[j][k];
      b[i] -= factor * b[k];
    }
  }
  return b[N - 1] / a[N - 1][N - 1];
}

}  // namespace fvd::metrology
