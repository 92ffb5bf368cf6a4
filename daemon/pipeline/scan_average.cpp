#include "daemon/pipeline/scan_average.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <sstream>

namespace fvd {

ScanAverage::ScanAverage(int width, int height)
    : mean_m_(width, height), squares_m2_(width, height), variance_m2_(width, height), reasons_(width, height) {}

void ScanAverage::add(const HeightMap& map) {
  assert(map.height_m.width() == mean_m_.width() && map.height_m.height() == mean_m_.height());
  ++scans_;
  const auto heights = map.height_m.pixels();
  const auto sigmas = map.sigma_m.pixels();
  const auto masks = map.mask.pixels();
  const auto mean = mean_m_.pixels();
  const auto squares = squares_m2_.pixels();
  const auto variance = variance_m2_.pixels();
  const auto reasons = reasons_.pixels();
  for (std::size_t i = 0; i < mean.size(); ++i) {
    reasons[i] = static_cast<MaskReasons>(reasons[i] | masks[i]);
    if (reasons[i] != 0) continue;
    const double height = static_cast<double>(heights[i]);
    const double from_mean = height - mean[i];
    mean[i] += from_mean / scans_;
    squares[i] += from_mean * (height - mean[i]);
    variance[i] += sigmas[i] * sigmas[i];
  }
}

RepeatedScans ScanAverage::finish(HeightMap& map) const {
  assert(scans_ >= 2);
  constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
  constexpr double kUmPerMetre = 1e6;
  RepeatedScans repeated{scans_, Plane<float>(mean_m_.width(), mean_m_.height()), {}};
  const auto heights = map.height_m.pixels();
  const auto sigmas = map.sigma_m.pixels();
  const auto masks = map.mask.pixels();
  const auto sd = repeated.sd_m.pixels();
  double sum_m2 = 0.0;
  std::size_t valid = 0;
  for (std::size_t i = 0; i < sd.size(); ++i) {
    masks[i] = reasons_.pixels()[i];
    if (masks[i] != 0) {
      heights[i] = sigmas[i] = sd[i] = kHole;
      continue;
    }
    const double variance_m2 = squares_m2_.pixels()[i] / (scans_ - 1);
    heights[i] = static_cast<float>(mean_m_.pixels()[i]);
    sigmas[i] = std::sqrt(variance_m2_.pixels()[i]) / static_cast<float>(scans_);
    sd[i] = static_cast<float>(std::sqrt(variance_m2));
    sum_m2 += variance_m2;
    ++valid;
  }
  if (valid > 0) repeated.sd_rms_um = kUmPerMetre * std::sqrt(sum_m2 / static_cast<double>(valid));
  return repeated;
}

std::optional<Warning> scatter_warning(const RepeatedScans& repeated, const HeightMap& map) {
  constexpr double kMostRatio = 3.0;
  constexpr double kUmPerMetre = 1e6;
  double squares_m2 = 0.0;
  std::size_t valid = 0;
  for (const float sigma_m : map.sigma_m.pixels()) {
    if (std::isnan(sigma_m)) continue;
    squares_m2 += static_cast<double>(sigma_m) * static_cast<double>(sigma_m);
    ++valid;
  }
  if (valid == 0 || !repeated.sd_rms_um) return std::nullopt;
  const double seen_um = *repeated.sd_rms_um;
  const double expected_um = kUmPerMetre * std::sqrt(repeated.scans * squares_m2 / static_cast<double>(valid));
  if (!(seen_um > kMostRatio * expected_um)) return std::nullopt;
  std::ostringstream text;
  text.precision(3);
  text << "the " << repeated.scans << " scans scatter by " << seen_um
       << " um (root mean square), by their own standard "
       << "errors it would be " << expected_um
       << " um: the part or the instrument moves or warms from scan to scan, and the standard errors of the mean, on "
          "which U rests, do not contain that";
  return Warning{"repeat_scatter", text.str()};
}

}  // namespace fvd
