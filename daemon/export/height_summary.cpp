#include "daemon/export/height_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <vector>

#include "core/units.hpp"

namespace fvd {

namespace {

double um(float metres) { return static_cast<double>(metres) / kMetresPerMicrometer; }

/// The value below which the fraction of the others lies (nearest rank). Reorders.
float quantile(std::vector<float>& values, double fraction) {
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(fraction * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double median_um(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return um(*middle);
  return (um(*std::max_element(values.begin(), middle)) + um(*middle)) / 2;
}

void count_reasons(std::uint8_t mask, HoleCounts& holes) {
  if ((mask & mask_reason::kLowProminence) != 0) ++holes.low_prominence;
  if ((mask & mask_reason::kFirstSlice) != 0) ++holes.first_slice;
  if ((mask & mask_reason::kLastSlice) != 0) ++holes.last_slice;
  if ((mask & mask_reason::kNotBracketed) != 0) ++holes.not_bracketed;
  if ((mask & mask_reason::kSaturated) != 0) ++holes.saturated;
  if ((mask & mask_reason::kInsignificant) != 0) ++holes.insignificant;
  if ((mask & mask_reason::kEdgeBleeding) != 0) ++holes.edge_bleeding;
}

}  // namespace

HeightSummary summarize_heights(const HeightMap& map) {
  HeightSummary summary;
  summary.points = map.mask.pixels().size();
  for (const std::uint8_t mask : map.mask.pixels()) count_reasons(mask, summary.holes);
  std::vector<float> valid;
  valid.reserve(summary.points);
  std::copy_if(map.height_m.pixels().begin(), map.height_m.pixels().end(), std::back_inserter(valid),
               [](float height) { return std::isfinite(height); });
  summary.valid = valid.size();
  if (valid.empty()) return summary;
  HeightValues values;
  values.min_um = um(*std::min_element(valid.begin(), valid.end()));
  values.max_um = um(*std::max_element(valid.begin(), valid.end()));
  values.mean_um = std::accumulate(valid.begin(), valid.end(), 0.0, [](double sum, float z) { return sum + um(z); }) /
                   static_cast<double>(valid.size());
  values.median_um = median_um(valid);
  values.low_um = um(quantile(valid, 0.005));
  values.high_um = um(quantile(valid, 0.995));
  summary.height = values;
  valid.clear();
  std::copy_if(map.sigma_m.pixels().begin(), map.sigma_m.pixels().end(), std::back_inserter(valid),
               [](float sigma) { return std::isfinite(sigma); });
  if (!valid.empty()) summary.sigma_median_um = median_um(valid);
  return summary;
}

}  // namespace fvd
