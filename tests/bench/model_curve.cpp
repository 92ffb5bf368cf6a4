#include "tests/bench/model_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/focus/fit/row_fit.hpp"
#include "core/focus/measure/focus_settings.hpp"
#include "core/focus/measure/slice_binner.hpp"
#include "tests/bench/accuracy_scans.hpp"

namespace fvd::bench {

namespace {

constexpr double kTableStep_widths = 0.001;
constexpr double kTableReach_widths = 6.0;  // widths that the table covers
constexpr double kPeakCode = 30000;         // of the curve
constexpr double kFloorShare = 0.10;        // what the focus measure shows of noise alone, of the peak
constexpr double kNoiseShare = 0.01;        // standard deviation, of the peak

/// The root of the passed power at a blur of sigma pixels.
double response(double sigma) {
  constexpr double kCutoff_cycles_per_px = 0.40;
  constexpr int kNodes = 160;
  double power = 0.0;
  for (int j = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i) {
      const double fx = 0.5 * (i + 0.5) / kNodes;
      const double fy = 0.5 * (j + 0.5) / kNodes;
      const double nu = std::hypot(fx, fy) / kCutoff_cycles_per_px;
      if (nu >= 1.0) continue;
      const double lens = 2.0 / std::numbers::pi * (std::acos(nu) - nu * std::sqrt(1.0 - nu * nu));
      const double omega = 2.0 * std::numbers::pi;
      const double blur = std::exp(-0.5 * omega * omega * (fx * fx + fy * fy) * sigma * sigma);
      const double difference = 2.0 - 2.0 * std::cos(omega * fx);
      power += std::pow(lens * blur * difference, 2);
    }
  }
  return std::sqrt(power);
}

}  // namespace

ModelCurve::ModelCurve() {
  // F over blur first; half the peak gives the width.
  const double top = response(0.0);
  std::vector<double> over_blur;
  for (int i = 0; i <= 1600; ++i) over_blur.push_back(response(0.01 * i) / top);
  std::size_t half = 0;
  while (over_blur[half] > 0.5) ++half;
  const double at_half =
      0.01 * (static_cast<double>(half) - (0.5 - over_blur[half]) / (over_blur[half - 1] - over_blur[half]));
  for (double u = 0.0; u <= kTableReach_widths; u += kTableStep_widths) {
    const double place = std::min(u * 2.0 * at_half / 0.01, 1598.0);
    const auto i = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(i);
    values_.push_back((1.0 - part) * over_blur[i] + part * over_blur[i + 1]);
  }
}

double ModelCurve::at(double u) const {
  const double place = std::min(std::abs(u) / kTableStep_widths, static_cast<double>(values_.size() - 2));
  const auto i = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(i);
  return (1.0 - part) * values_[i] + part * values_[i + 1];
}

BoundRatio rms_over_bound(const ModelCurve& curve, double step) {
  constexpr int kCurves = 8192;
  constexpr double kRange = 3.0;  // widths on either side of the peak
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  BoundRatio result;
  result.bin_slices = choose_bin_slices(step, 1.0);
  FocusSettings settings;
  settings.bin_slices = result.bin_slices;
  std::vector<double> truth(kCurves);
  for (double& z : truth) z = kRange + step * result.bin_slices * uniform(random);
  const int slices = static_cast<int>(2 * kRange / step);

  PeakAccumulator<std::uint8_t> accumulator(kCurves, 1, {.bins = result.bin_slices > 1});
  SliceBinner<std::uint8_t> binner(kCurves, result.bin_slices);
  SampleHeights heights(result.bin_slices, slices);
  const auto row = accumulator.row(0);
  std::vector<std::uint16_t> codes(kCurves);
  const std::vector<std::uint8_t> nothing(kCurves);
  double information = 0.0;  // mean over the curves of sum F'^2
  for (int k = 0; k < slices; ++k) {
    const double z = step * k;
    for (std::size_t x = 0; x < truth.size(); ++x) {
      const double u = z - truth[x];
      const double value = curve.at(u) + kFloorShare + kNoiseShare * normal(random);
      codes[x] = static_cast<std::uint16_t>(std::lround(std::clamp(kPeakCode * value, 0.0, 65000.0)));
      const double slope = (curve.at(u + 0.002) - curve.at(u - 0.002)) / 0.004;
      information += slope * slope / kCurves;
    }
    const Sample<std::uint8_t> sample{codes.data(), nothing.data(), nothing.data()};
    binner.add(row, std::span(&sample, 1), k);
    heights.push(z);
  }
  if (heights.pending() > 0) binner.close(row, heights.samples(), heights.pending());
  const double bound = kNoiseShare / std::sqrt(information);

  const RowFit fit(heights.means_um(), settings, PixelFormat::kMono8, PeakMethod::kFiveSample);
  // In the units of the codes: the noise of a pixel that gives this noise of a sample.
  const double pixel =
      kNoiseShare * kPeakCode / sample_noise(settings, 1.0, 0.0) / sharpness_code(settings, PixelFormat::kMono8).gain;
  const std::vector<float> noise_grey(kCurves, static_cast<float>(pixel));
  std::vector<float> noise(kCurves);
  std::vector<float> height_m(kCurves);
  std::vector<float> variance_m2(kCurves);
  std::vector<float> prominence(kCurves);
  std::vector<MaskReasons> mask(kCurves);
  const std::vector<float> least(kCurves);
  fit.find_noise(row.curve, noise_grey.data(), kCurves, noise.data());
  fit.fit(row.curve, noise.data(), least.data(), kCurves,
          {height_m.data(), variance_m2.data(), prominence.data(), mask.data()});
  ErrorSum errors;
  for (std::size_t x = 0; x < truth.size(); ++x) {
    if (mask[x] != 0) continue;
    errors.add(static_cast<double>(height_m[x]) * 1e6 - truth[x], std::sqrt(static_cast<double>(variance_m2[x])) * 1e6);
  }
  result.ratio = errors.rms() / bound;
  result.sigma_ratio = errors.sigma_ratio();
  result.share = errors.count / kCurves;
  return result;
}

}  // namespace fvd::bench
