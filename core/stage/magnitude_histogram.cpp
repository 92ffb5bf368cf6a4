#include "core/stage/magnitude_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fvd {

void MagnitudeHistogram::add(double magnitude) {
  if (magnitude < kLowest) {
    ++counts.front();
    return;
  }
  const double place = std::floor(std::log2(magnitude / kLowest) * kBinsPerOctave);
  ++counts[1 + static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(kBins - 2)))];
}

void MagnitudeHistogram::merge(const MagnitudeHistogram& other) {
  std::transform(counts.begin(), counts.end(), other.counts.begin(), counts.begin(), std::plus<>());
}

std::uint64_t MagnitudeHistogram::total() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::optional<double> MagnitudeHistogram::quantile(double p) const {
  const std::uint64_t n = total();
  if (n == 0) return std::nullopt;
  const auto rank = std::max(std::uint64_t{1}, static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(n))));
  std::uint64_t seen = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && (seen += counts[bin]) < rank) ++bin;
  if (bin == 0) return 0.0;
  return kLowest * std::exp2((static_cast<double>(bin - 1) + 0.5) / kBinsPerOctave);
}

}  // namespace fvd
