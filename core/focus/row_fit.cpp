#include "core/focus/row_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/focus/height_map.hpp"
#include "core/focus/peak_accumulator.hpp"
#include "core/focus/peak_fit.hpp"
#include "core/units.hpp"

namespace fvd {

namespace {

/// c of the modified Laplacian; measured on blurred textures, see README.md.
constexpr double kLaplacianNoise = 4.0;

}  // namespace

double sample_noise(const FocusSettings& settings, double noise_grey, double sharpness) noexcept {
  const double window = settings.window_px;
  switch (settings.focus_operator) {
    case FocusOperator::kModifiedLaplacian:
      return kLaplacianNoise * window * noise_grey;
    case FocusOperator::kTenengrad:
      // g = (gx, gy) of white noise has 12 sigma^2 each; neighbouring gradients share pixels, which doubles the sum.
      return 2.0 * std::sqrt(2.0 * 12.0 * sharpness) * noise_grey;
    case FocusOperator::kIntensity:
      return window * noise_grey;
  }
  return 0.0;
}

RowFit::RowFit(std::vector<double> z_um, const FocusSettings& settings, PixelFormat format, PeakMethod method)
    : settings_(settings),
      code_(sharpness_code(settings, format)),
      method_(method),
      heights_(std::move(z_um)),
      bin_gain_(settings.bin_slices / std::ldexp(1.0, bin_shift(settings.bin_slices))) {}

void RowFit::fit(const CurveRow& row, float* noise_grey, int width, const FitRow& out) const noexcept {
  // A bin's sample is the sum of `slices` codes: the signal grows with their number, the noise with its root.
  const double slices = settings_.bin_slices;
  const double scale = code_.gain * bin_gain_ * SharpnessCode::kUnit;
  const double share = (code_.root ? scale * scale : scale) / std::sqrt(slices);
  const bool constant = settings_.focus_operator != FocusOperator::kTenengrad;
  const double at_one = sample_noise(settings_, 1.0, 0.0) * share;
  for (int x = 0; x < width; ++x) {
    const double noise = static_cast<double>(noise_grey[x]);
    noise_grey[x] = static_cast<float>(
        constant ? noise * at_one
                 : sample_noise(settings_, noise, code_.decode(row.peak[x]) / (bin_gain_ * bin_gain_)) * share);
  }
  if (method_ == PeakMethod::kFiveSample) {
    const FitParameters parameters{static_cast<float>(settings_.min_prominence),
                                   static_cast<float>(settings_.min_significance),
                                   static_cast<float>(SharpnessCode::kUnit), code_.root};
    focus_kernels().fit_five(row, heights_.view(), noise_grey, width, parameters, out);
  } else {
    fit_triples(row, noise_grey, width, out);
  }
}

void RowFit::fit_triples(const CurveRow& row, const float* noise, int width, const FitRow& out) const noexcept {
  const HeightTable table = heights_.view();
  const auto decode = [this](std::uint16_t code) {
    const double value = code * SharpnessCode::kUnit;
    return code_.root ? value * value : value;
  };
  const double half_a_count = (code_.root ? 0.25 * SharpnessCode::kUnit : 0.5) * SharpnessCode::kUnit;
  for (int x = 0; x < width; ++x) {
    const auto index = static_cast<std::ptrdiff_t>(row.peak_index[x]);
    const double peak = decode(row.peak[x]);
    const double minimum = decode(row.minimum[x]);
    const double prominence = peak > 0.0 ? (peak - minimum) / peak : 0.0;
    auto mask = static_cast<unsigned>(table.mask[index]);
    if (peak == 0.0 || prominence < settings_.min_prominence) mask |= mask_reason::kLowProminence;
    if (peak - minimum < settings_.min_significance * static_cast<double>(noise[x]))
      mask |= mask_reason::kInsignificant;
    if (row.saturated[x] != 0) mask |= mask_reason::kSaturated;
    std::optional<PeakPosition> position;
    if ((mask & (mask_reason::kFirstSlice | mask_reason::kLastSlice)) == 0) {
      position = fit_peak(method_,
                          {table.z_um[index - 1], table.z_um[index], table.z_um[index + 1], decode(row.left[x]), peak,
                           decode(row.right[x]), static_cast<double>(noise[x])},
                          half_a_count);
      if (!position) mask |= mask_reason::kNotBracketed;
    }
    const bool valid = mask == 0;
    out.height_m[x] = valid ? static_cast<float>(position->z_um * kMetresPerMicrometer) : NAN;
    out.sigma_m[x] = valid ? static_cast<float>(position->sigma_um * kMetresPerMicrometer) : NAN;
    out.prominence[x] = static_cast<float>(prominence);
    out.mask[x] = static_cast<std::uint8_t>(mask);
  }
}

}  // namespace fvd
