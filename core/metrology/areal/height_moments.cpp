#include "core/metrology/areal/height_moments.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace fvd::metrology {
namespace {

constexpr std::size_t kBlock = 512;

/// The sum of term(value): blocks are summed for themselves, so that rounding does not grow with millions of terms.
template <typename Term>
double sum(std::span<const double> values, Term&& term) {
  double total = 0.0;
  for (std::size_t first = 0; first < values.size(); first += kBlock) {
    double part = 0.0;
    for (const double value : values.subspan(first, std::min(kBlock, values.size() - first))) part += term(value);
    total += part;
  }
  return total;
}

}  // namespace

double mean_of_sorted_um(std::span<const double> descending) {
  assert(!descending.empty());
  // About the median, so that a surface far from z = 0 loses no digits.
  const double median_um = descending[descending.size() / 2];
  return median_um + sum(descending, [=](double z) { return z - median_um; }) / static_cast<double>(descending.size());
}

HeightMoments height_moments(std::span<const double> descending) {
  assert(!descending.empty());
  const auto count = static_cast<double>(descending.size());
  HeightMoments moments;
  moments.peak_um = descending.front();
  moments.pit_um = -descending.back();
  moments.mean_absolute_um = sum(descending, [](double z) { return std::abs(z); }) / count;
  const double square = sum(descending, [](double z) { return z * z; }) / count;
  moments.root_mean_square_um = std::sqrt(square);
  if (square == 0.0) return moments;
  const double per_um = 1.0 / moments.root_mean_square_um;
  moments.skewness = sum(descending, [=](double z) { return (z * per_um) * (z * per_um) * (z * per_um); }) / count;
  moments.kurtosis = sum(descending,
                         [=](double z) {
                           const double squared = (z * per_um) * (z * per_um);
                           return squared * squared;
                         }) /
                     count;
  return moments;
}

}  // namespace fvd::metrology
