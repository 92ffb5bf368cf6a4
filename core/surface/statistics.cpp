#include "core/surface/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/units.hpp"
#include "core/surface/mask_reason.hpp"

namespace fvd {

namespace {

double um(float metres) { return static_cast<double>(metres) / kMetresPerMicrometer; }

using Values = std::vector<float>;

/// The value of this rank in the part of values from first to end. Reorders that part.
float ranked(Values& values, std::size_t first, std::size_t rank, std::size_t end) {
  const auto at = [&values](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(rank), at(end));
  return values[rank];
}

/// Reorders: below the middle come the smaller ones.
double median_um(Values& values) {
  const std::size_t middle = values.size() / 2;
  const float upper = ranked(values, 0, middle, values.size());
  if (values.size() % 2 == 1) return um(upper);
  return (um(*std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle))) + um(upper)) / 2;
}

/// The value below which the fraction of the others lies (nearest rank), where median_um() has been before.
float quantile(Values& values, double fraction) {
  const auto rank = static_cast<std::size_t>(std::lround(fraction * static_cast<double>(values.size() - 1)));
  const std::size_t middle = values.size() / 2;
  return rank < middle ? ranked(values, 0, rank, middle) : ranked(values, middle, rank, values.size());
}

void count_reasons(MaskReasons reasons, std::size_t points, HoleCounts& holes) {
  if ((reasons & mask_reason::kLowProminence) != 0) holes.low_prominence += points;
  if ((reasons & mask_reason::kFirstSlice) != 0) holes.first_slice += points;
  if ((reasons & mask_reason::kLastSlice) != 0) holes.last_slice += points;
  if ((reasons & mask_reason::kNotBracketed) != 0) holes.not_bracketed += points;
  if ((reasons & mask_reason::kSaturated) != 0) holes.saturated += points;
  if ((reasons & mask_reason::kInsignificant) != 0) holes.insignificant += points;
  if ((reasons & mask_reason::kEdgeBleeding) != 0) holes.edge_bleeding += points;
  if ((reasons & mask_reason::kBroadCurve) != 0) holes.broad_curve += points;
  if ((reasons & mask_reason::kNarrowCurve) != 0) holes.narrow_curve += points;
  if ((reasons & mask_reason::kSecondPeak) != 0) holes.second_peak += points;
  if ((reasons & mask_reason::kEdgeBand) != 0) holes.edge_band += points;
  if ((reasons & mask_reason::kMaxSigma) != 0) holes.max_sigma += points;
  if ((reasons & mask_reason::kOutOfView) != 0) holes.out_of_view += points;
}

}  // namespace

HeightSummary summarize_heights(const Plane<float>& height_m, const Plane<float>& sigma_m,
                                const Plane<MaskReasons>& mask) {
  HeightSummary summary;
  summary.points = mask.pixels().size();
  std::vector<std::size_t> points_of(std::size_t{1} << std::numeric_limits<MaskReasons>::digits);
  for (const MaskReasons reasons : mask.pixels()) ++points_of[reasons];
  for (std::size_t reasons = 1; reasons < points_of.size(); ++reasons) {
    if (points_of[reasons] > 0) count_reasons(static_cast<MaskReasons>(reasons), points_of[reasons], summary.holes);
  }
  Values valid;
  valid.reserve(summary.points);
  std::copy_if(height_m.pixels().begin(), height_m.pixels().end(), std::back_inserter(valid),
               [](float height) { return std::isfinite(height); });
  summary.valid = valid.size();
  if (valid.empty()) return summary;
  HeightValues values;
  values.min_um = um(*std::min_element(valid.begin(), valid.end()));
  values.max_um = um(*std::max_element(valid.begin(), valid.end()));
  values.mean_um =
      std::accumulate(valid.begin(), valid.end(), 0.0) / static_cast<double>(valid.size()) / kMetresPerMicrometer;
  values.median_um = median_um(valid);
  values.low_um = um(quantile(valid, 0.005));
  values.high_um = um(quantile(valid, 0.995));
  summary.height = values;
  valid.clear();
  std::copy_if(sigma_m.pixels().begin(), sigma_m.pixels().end(), std::back_inserter(valid),
               [](float sigma) { return std::isfinite(sigma); });
  if (!valid.empty()) summary.sigma_median_um = median_um(valid);
  return summary;
}

}  // namespace fvd
