#include "core/focus/fit/row_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/units.hpp"
#include "core/focus/fit/height_map.hpp"
#include "core/focus/fit/peak_fit.hpp"
#include "core/focus/kernels/five_sample_fit.hpp"
#include "core/focus/measure/peak_accumulator.hpp"

namespace fvd {

namespace {

/// c of the Laplacians; measured on blurred textures, see README.md.
constexpr double kLaplacianNoise = 4.0;
constexpr double kDiagonalNoise = 15.0;

float shape_error(const FocusSettings& settings) {
  if (has_light_tails(settings.focus_operator)) return 0.0F;
  return settings.bin_slices > 1 ? kBinnedShapeError : kShapeError;
}

}  // namespace

double sample_noise(const FocusSettings& settings, double noise_grey, double sharpness) noexcept {
  const double window = window_norm(settings);
  switch (settings.focus_operator) {
    case FocusOperator::kModifiedLaplacian:
      return kLaplacianNoise * window * noise_grey;
    case FocusOperator::kDiagonalLaplacian:
      return kDiagonalNoise * window * noise_grey;
    case FocusOperator::kTenengrad:
      // g = (gx, gy) of white noise has 12 sigma^2 each; neighbouring gradients share pixels, which doubles the sum.
      return 2.0 * std::sqrt(2.0 * 12.0 * sharpness) * noise_grey;
    case FocusOperator::kIntensity:
      return window * noise_grey;
  }
  return 0.0;
}

RowFit::RowFit(std::vector<double> z_um, const FocusSettings& settings, PixelFormat format, PeakMethod method,
               const ScanCurves& curves)
    : settings_(settings),
      code_(sharpness_code(settings, format)),
      method_(method),
      curves_(curves),
      z_um_(std::move(z_um)),
      heights_(height_table(z_um_)),
      bin_gain_(settings.bin_slices / std::ldexp(1.0, bin_shift(settings.bin_slices))) {
  for (HeightEntry& entry : heights_) {
    if (entry.mask != 0) continue;
    entry.least_neighbours = static_cast<float>(curves_.limits.neighbours(static_cast<double>(entry.scale_um)));
  }
}

void RowFit::find_noise(const CurveRow& row, const float* noise_grey, int width, float* noise) const noexcept {
  // A bin's sample is the sum of `slices` codes: the signal grows with their number, the noise with its root.
  const double slices = settings_.bin_slices;
  const double scale = code_.gain * bin_gain_ * SharpnessCode::kUnit;
  const double to_share = (code_.root ? scale * scale : scale) / std::sqrt(slices);
  if (!noise_follows_sharpness()) {
    const auto at_one = static_cast<float>(sample_noise(settings_, 1.0, 0.0) * to_share);
    for (int x = 0; x < width; ++x) noise[x] = noise_grey[x] * at_one;
  } else {
    for (int x = 0; x < width; ++x) {
      const double sharpness = code_.decode(row.peak[x]) / (bin_gain_ * bin_gain_);
      noise[x] = static_cast<float>(sample_noise(settings_, static_cast<double>(noise_grey[x]), sharpness) * to_share);
    }
  }
}

std::array<float, 5> RowFit::shares(const CurveRow& row, int x) const noexcept {
  const double floor = static_cast<double>(kFloorShare) * share(row.minimum[x]);
  const double amplitude = share(row.peak[x]) - floor;
  const auto over_floor = [&](std::uint16_t code) {
    return static_cast<float>(std::max(0.0, (share(code) - floor) / amplitude));
  };
  return {over_floor(row.left2[x]), over_floor(row.left[x]), 1.0F, over_floor(row.right[x]), over_floor(row.right2[x])};
}

void RowFit::fit(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
                 const FitRow& out) const noexcept {
  if (method_ == PeakMethod::kFiveSample) {
    const FitParameters parameters{static_cast<float>(settings_.min_prominence),
                                   static_cast<float>(settings_.min_significance),
                                   shape_error(settings_),
                                   static_cast<float>(curves_.misfit),
                                   static_cast<float>(SharpnessCode::kUnit),
                                   code_.root,
                                   curves_.bias,
                                   static_cast<float>(curves_.limits.least_bend_per_um2),
                                   static_cast<float>(curves_.limits.least_shoulder),
                                   CurveLimits::kMostNeighbours,
                                   has_light_tails(settings_.focus_operator)};
    focus_kernels().fit_five(row, heights_, noise, least_amplitude, width, parameters, out);
  } else {
    fit_triples(row, noise, least_amplitude, width, out);
  }
  if (row.second != nullptr) mark_second_peaks(row, width, out);
}

void RowFit::mark_second_peaks(const CurveRow& row, int width, const FitRow& out) const noexcept {
  constexpr MaskReasons kNoPeak = mask_reason::kLowProminence | mask_reason::kInsignificant;
  for (int x = 0; x < width; ++x) {
    if ((out.mask[x] & kNoPeak) != 0) continue;
    const double minimum = share(row.minimum[x]);
    const double rise = share(second_peak::sharpness(row.second[x])) - minimum;
    if (rise <= settings_.tests.second_peak * (share(row.peak[x]) - minimum)) continue;
    out.mask[x] |= mask_reason::kSecondPeak;
    out.height_m[x] = NAN;
    out.variance_m2[x] = NAN;
  }
}

unsigned RowFit::shape_reasons(const CurveRow& row, int x) const noexcept {
  const HeightEntry& at = heights_[row.peak_index[x]];
  if (at.mask != 0) return 0;
  const double floor = static_cast<double>(kFloorShare) * share(row.minimum[x]);
  const double amplitude = std::max(share(row.peak[x]) - floor, std::numeric_limits<double>::min());
  const auto over_floor = [&](std::uint16_t code) {
    return std::max((share(code) - floor) / amplitude, static_cast<double>(kSmallestShare));
  };
  const double left = over_floor(row.left[x]);
  const double right = over_floor(row.right[x]);
  const double near = left + right;
  // Without one of the samples two away the other stands for both.
  const double left2 = at.u_left2 != 0.0F ? over_floor(row.left2[x]) : 0.0;
  const double right2 = at.u_right2 != 0.0F ? over_floor(row.right2[x]) : 0.0;
  const double far = (at.u_left2 != 0.0F ? left2 : right2) + (at.u_right2 != 0.0F ? right2 : left2);
  const auto u_left = static_cast<double>(at.u_left);
  const auto u_right = static_cast<double>(at.u_right);
  const auto scale_um = static_cast<double>(at.scale_um);
  const double bend = ((1.0 / std::sqrt(right) - 1.0) / u_right - (1.0 / std::sqrt(left) - 1.0) / u_left) /
                      (u_right - u_left);  // of G through three samples
  unsigned reasons = 0;
  const bool clipped = (row.clipped[x] & clipping::kPeakBits) != 0;  // that flattens a curve's top
  if (!clipped && bend < curves_.limits.least_bend_per_um2 * scale_um * scale_um) reasons |= mask_reason::kBroadCurve;
  const auto least = static_cast<double>(at.least_neighbours);
  const bool uneven = std::abs(at.u_left + at.u_right) > kUneven;
  const double least_shoulder = curves_.limits.least_shoulder * (uneven ? static_cast<double>(kUnevenShoulder) : 1.0);
  if (near < least || std::min(left, right) < static_cast<double>(kLowerNeighbour) * least ||
      (near - far < least_shoulder * (2.0 - near) && near < static_cast<double>(CurveLimits::kMostNeighbours))) {
    reasons |= mask_reason::kNarrowCurve;
  }
  return reasons;
}

void RowFit::fit_triples(const CurveRow& row, const float* noise, const float* least_amplitude, int width,
                         const FitRow& out) const noexcept {
  const double half_a_count = (code_.root ? 0.25 * SharpnessCode::kUnit : 0.5) * SharpnessCode::kUnit;
  for (int x = 0; x < width; ++x) {
    const auto index = static_cast<std::size_t>(row.peak_index[x]);
    const double peak = share(row.peak[x]);
    const double minimum = share(row.minimum[x]);
    const double prominence = peak > 0.0 ? (peak - minimum) / peak : 0.0;
    auto mask = static_cast<unsigned>(heights_[index].mask);
    if (peak == 0.0 || prominence < settings_.min_prominence) mask |= mask_reason::kLowProminence;
    if (peak - minimum < settings_.min_significance * static_cast<double>(noise[x]))
      mask |= mask_reason::kInsignificant;
    if (peak - minimum < static_cast<double>(least_amplitude[x])) mask |= mask_reason::kEdgeBleeding;
    const int clipped = row.clipped[x] & clipping::kPeakBits;
    if (clipped == clipping::kNoPeak) mask |= mask_reason::kSaturated;
    std::optional<PeakPosition> position;
    if ((mask & (mask_reason::kFirstSlice | mask_reason::kLastSlice)) == 0) {
      position = fit_peak(method_,
                          {z_um_[index - 1], z_um_[index], z_um_[index + 1], share(row.left[x]), peak,
                           share(row.right[x]), static_cast<double>(noise[x])},
                          half_a_count);
      if (!position) mask |= mask_reason::kNotBracketed;
      mask |= shape_reasons(row, x);
    }
    const bool valid = mask == 0;
    out.height_m[x] = valid ? static_cast<float>(position->z_um * kMetresPerMicrometer) : NAN;
    const double sigma_m = valid ? position->sigma_um * kMetresPerMicrometer : std::nan("");
    out.variance_m2[x] = static_cast<float>(sigma_m * sigma_m);
    if (clipped == clipping::kSome) out.variance_m2[x] *= clipping::kSomeVariance;
    if (clipped == clipping::kMany) out.variance_m2[x] *= clipping::kManyVariance;
    out.prominence[x] = static_cast<float>(prominence);
    out.mask[x] = static_cast<MaskReasons>(mask);
  }
}

}  // namespace fvd
