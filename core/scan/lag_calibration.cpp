#include "core/scan/lag_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMinPoints = 100;
/// Standard deviation of a normal distribution over its median absolute deviation, and of the median over that of the
/// mean.
constexpr double kSdOverMad = 1.4826;
constexpr double kMedianOverMean = 1.2533;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LagResult measure_lag(const HeightMap& upwards, const HeightMap& downwards, double speed_um_per_s) {
  if (upwards.height_m.width() != downwards.height_m.width() ||
      upwards.height_m.height() != downwards.height_m.height()) {
    throw Error(ErrorCode::kBadInput, "the two scans of a lag calibration have different shapes");
  }
  std::vector<double> differences_um;
  const auto up = upwards.height_m.pixels();
  const auto down = downwards.height_m.pixels();
  const auto up_mask = upwards.mask.pixels();
  const auto down_mask = downwards.mask.pixels();
  for (std::size_t i = 0; i < up.size(); ++i) {
    if (up_mask[i] == 0 && down_mask[i] == 0) {
      differences_um.push_back((static_cast<double>(down[i]) - static_cast<double>(up[i])) * 1e6);
    }
  }
  if (differences_um.size() < kMinPoints) {
    throw Error(ErrorCode::kTooFewValid, "only " + std::to_string(differences_um.size()) +
                                             " points are valid in both scans; a lag calibration needs " +
                                             std::to_string(kMinPoints) + ": use a surface with texture");
  }
  const double to_us = 1e6 / (2.0 * speed_um_per_s);
  LagResult result;
  result.points = static_cast<int>(differences_um.size());
  const double middle_um = median(differences_um);
  for (double& difference : differences_um) difference = std::abs(difference - middle_um);
  result.lag_us = middle_um * to_us;
  result.sd_us =
      kMedianOverMean * kSdOverMad * median(differences_um) * to_us / std::sqrt(static_cast<double>(result.points));
  return result;
}

}  // namespace fvd
