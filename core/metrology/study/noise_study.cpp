#include "core/metrology/study/noise_study.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/metrology/study/scan_stack.hpp"

namespace fvd::metrology {
namespace {

bool counts(const ScanStack& stack, const Region& region, int x, int y) {
  return is_inside(region, x, y) && !std::isnan(stack.mean_um.at(x, y));
}

/// Mean of the squared standard errors of all scans, over the points that count. Absent where a scan has none.
std::optional<double> mean_variance(std::span<const HeightField* const> scans, const ScanStack& stack,
                                    const Region& region) {
  const bool known = std::all_of(scans.begin(), scans.end(), [](const HeightField* scan) { return scan->has_sigma(); });
  if (!known) return std::nullopt;
  double sum = 0.0;
  for (const HeightField* scan : scans) {
    for (int y = 0; y < scan->height(); ++y) {
      for (int x = 0; x < scan->width(); ++x) {
        if (counts(stack, region, x, y)) sum += std::pow(static_cast<double>(scan->sigma_um.at(x, y)), 2);
      }
    }
  }
  return sum / (static_cast<double>(scans.size()) * stack.points);
}

}  // namespace

StudyOutcome<NoiseStudy> measurement_noise(std::span<const HeightField* const> scans, const Region& region) {
  StudyOutcome<ScanStack> stacked = stack_scans(scans, region, 2);
  if (StudyRefusal* refusal = std::get_if<StudyRefusal>(&stacked)) return std::move(*refusal);
  const ScanStack& stack = std::get<ScanStack>(stacked);
  const double freedom = static_cast<double>(scans.size()) - 1.0;

  NoiseStudy study;
  study.scans = static_cast<int>(scans.size());
  study.points = stack.points;
  study.valid_fraction = stack.valid_fraction;
  study.noise_map_um = Plane<float>(stack.mean_um.width(), stack.mean_um.height());
  double sum = 0.0;
  for (int y = 0; y < stack.mean_um.height(); ++y) {
    for (int x = 0; x < stack.mean_um.width(); ++x) {
      const double variance = stack.squares_um2.at(x, y) / freedom;
      study.noise_map_um.at(x, y) = static_cast<float>(std::sqrt(variance));
      if (counts(stack, region, x, y)) sum += variance;
    }
  }
  study.noise_um = std::sqrt(sum / stack.points);
  const std::optional<double> expected = mean_variance(scans, stack, region);
  if (expected && *expected > 0.0) study.over_sigma = study.noise_um / std::sqrt(*expected);
  return study;
}

}  // namespace fvd::metrology
