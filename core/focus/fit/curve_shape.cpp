#include "core/focus/fit/curve_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/focus/fit/sample_heights.hpp"
#include "core/focus/measure/sharpness_code.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxCurves = 4000;  // that are evaluated; their mean is good to 0.02 in p
constexpr std::size_t kMinCurves = 500;   // with fewer, p stays that of the fit
constexpr double kFitExponent = 2.0;      // of the five-sample fit
constexpr double kSecondExponent = 1.5;   // the excess is taken to be linear in p between these two and beyond
constexpr double kMinExponent = 1.25;     // of curves that the scenes of RESULTS.md show
constexpr double kMaxExponent = 2.2;
// Of curves that are fitted by their logarithm, exact for p without end; the excess is taken to be linear in 1/p.
// Below 0 tails end: sinc^2 is near to (1 - b u^2)^5.
constexpr double kEndingExponent = -4.0;
constexpr double kMostInverse = 0.5;
constexpr double kLeastInverse = -0.3;
constexpr double kMinNeighbourShare = 0.02;  // share of the peak: a smaller one tells more of noise than of the curve

/// G = F^(-1/p) as a parabola through the peak, where it is 1 and u is 0, and both its neighbours.
struct Parabola {
  double slope = 0.0;
  double bend = 0.0;  // coefficient of u^2
  double p = kFitExponent;

  /// F at u; for the exponents above.
  [[nodiscard]] double at(double u) const {
    const double g = 1.0 + (slope + bend * u) * u;
    if (p == kEndingExponent) return g > 0.0 ? g * g * g * g : 0.0;
    if (p == kGaussianExponent) return std::pow(g, -p);
    return p == kFitExponent ? 1.0 / (g * g) : 1.0 / (g * std::sqrt(g));
  }
  /// At the vertex; the highest where p is negative.
  [[nodiscard]] double lowest() const { return 1.0 - slope * slope / (4.0 * bend); }
};

double raised(double share, double p) {
  if (p == kFitExponent) return 1.0 / std::sqrt(share);
  return p == kSecondExponent ? 1.0 / std::cbrt(share * share) : std::pow(share, -1.0 / p);
}

std::optional<Parabola> parabola(const CurveTuple& tuple, const HeightEntry& at, double p) {
  const auto left = static_cast<double>(tuple.share[1]);
  const auto right = static_cast<double>(tuple.share[3]);
  if (at.mask != 0 || !(left > kMinNeighbourShare && right > kMinNeighbourShare)) return std::nullopt;
  const auto u_left = static_cast<double>(at.u_left);
  const auto u_right = static_cast<double>(at.u_right);
  const double rise_left = (raised(left, p) - 1.0) / u_left;
  const double rise_right = (raised(right, p) - 1.0) / u_right;
  Parabola result;
  result.p = p;
  result.bend = (rise_right - rise_left) / (u_right - u_left);
  result.slope = rise_left - result.bend * u_left;
  if (!(p * result.bend > 0.0) || !(result.lowest() > 0.0)) return std::nullopt;
  return result;
}

/// What the nearer of the samples two steps away has over what the others foretell; the farther is mostly noise.
std::optional<double> excess(const CurveTuple& tuple, const HeightEntry& at, double p) {
  const auto curve = parabola(tuple, at, p);
  if (!curve) return std::nullopt;
  const bool before = tuple.share[1] > tuple.share[3];
  const auto u = static_cast<double>(before ? at.u_left2 : at.u_right2);
  if (u == 0.0) return std::nullopt;
  return static_cast<double>(before ? tuple.share[0] : tuple.share[4]) - curve->at(u);
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <typename Pieces>
std::vector<double> joined(const Pieces& pieces) {
  std::vector<double> all;
  for (const auto& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

/// What the fit makes of curves (1 + bend u^2)^-p: of two, the vertex a fifth of a step from the peak's sample and
/// almost half a step.
VertexBias bias_of_fit(double bend, double p, bool logarithm) {
  constexpr std::array kVertices_steps{0.2, 0.45};
  constexpr int kCurves = static_cast<int>(kVertices_steps.size());
  constexpr double kPeakCode = 60000.0;
  std::array<std::array<std::uint16_t, kCurves>, 9> columns{};
  std::array<std::uint8_t, kCurves> saturated{};
  auto& [previous, previous2, peak, left, left2, right, right2, minimum, index] = columns;
  for (std::size_t x = 0; x < kVertices_steps.size(); ++x) {
    const auto code = [&](double u) {
      const double away = u - kVertices_steps[x];
      return static_cast<std::uint16_t>(std::lround(kPeakCode * std::pow(1.0 + bend * away * away, -p)));
    };
    left2[x] = code(-2.0);
    left[x] = code(-1.0);
    peak[x] = code(0.0);
    right[x] = code(1.0);
    right2[x] = code(2.0);
  }
  const std::array<HeightEntry, 1> heights{
      HeightEntry{.u_left2 = -2.0F, .u_left = -1.0F, .u_right = 1.0F, .u_right2 = 2.0F}};
  const std::array<float, kCurves> nothing{};
  // Without noise, and with a shape error of 1, the variance is the square of what the bias is divided by.
  FitParameters parameters{};
  parameters.shape_error = 1.0F;
  parameters.logarithm = logarithm;
  parameters.code_unit = static_cast<float>(SharpnessCode::kUnit);
  std::array<float, kCurves> height_m{};
  std::array<float, kCurves> variance_m2{};
  std::array<float, kCurves> prominence{};
  std::array<MaskReasons, kCurves> mask{};
  focus_kernels().fit_five({previous.data(), previous2.data(), peak.data(), left.data(), left2.data(), right.data(),
                            right2.data(), minimum.data(), index.data(), saturated.data()},
                           heights, nothing.data(), nothing.data(), kCurves, parameters,
                           {height_m.data(), variance_m2.data(), prominence.data(), mask.data()});
  std::array<double, kCurves> u{};
  std::array<double, kCurves> error{};
  for (std::size_t x = 0; x < kVertices_steps.size(); ++x) {
    if (mask[x] != 0) return {};
    u[x] = static_cast<double>(height_m[x]) * 1e6;  // the scale is 1 um
    error[x] = (u[x] - kVertices_steps[x]) / (std::sqrt(static_cast<double>(variance_m2[x])) * 1e6);
  }
  const double determinant = u[0] * u[1] * (u[1] * u[1] - u[0] * u[0]);
  VertexBias bias;
  bias.linear = static_cast<float>((error[0] * u[1] * u[1] * u[1] - error[1] * u[0] * u[0] * u[0]) / determinant);
  bias.cubic = static_cast<float>((u[0] * error[1] - u[1] * error[0]) / determinant);
  return bias;
}

/// The curves that are looked at, in pieces for many threads. Always in as many, so that sums do not depend on the
/// number of threads.
class Curves {
 public:
  static constexpr int kPieces = 8;

  Curves(std::span<const CurveTuple> tuples, const std::vector<double>& z_um)
      : tuples_(tuples), heights_(height_table(z_um)), count_(std::min(tuples.size(), kMaxCurves)) {}

  /// look(tuple, what is known of its peak's sample).
  template <typename Look>
  void each(int piece, const Look& look) const {
    for (auto i = static_cast<std::size_t>(piece); i < count_; i += kPieces) {
      const CurveTuple& tuple = tuples_[count_ == tuples_.size() ? i : spread_index(i, tuples_.size())];
      look(tuple, heights_[static_cast<std::size_t>(tuple.index)]);
    }
  }

 private:
  std::span<const CurveTuple> tuples_;
  std::vector<HeightEntry> heights_;
  std::size_t count_;
};

/// From the excesses at two exponents to that at which they vanish.
double heavy_exponent(double at_fit, double at_second) {
  const double slope = (at_fit - at_second) / (kFitExponent - kSecondExponent);
  return std::clamp(kFitExponent - at_fit / slope, kMinExponent, kMaxExponent);
}
double light_exponent(double at_ending, double at_gaussian) {
  const double inverse = -at_gaussian / (at_ending - at_gaussian) / kEndingExponent;
  const double nearest = std::clamp(inverse, kLeastInverse, kMostInverse);
  return std::abs(nearest) < 1.0 / kGaussianExponent ? kGaussianExponent : 1.0 / nearest;
}

/// The exponent at which the excess vanishes in the mean; nothing where too few curves tell, or their mean tells of
/// none.
std::optional<double> exponent_of(const Curves& curves, WorkerPool& pool, bool logarithm) {
  const double first = logarithm ? kEndingExponent : kFitExponent;  // of lighter tails than the second
  const double second = logarithm ? kGaussianExponent : kSecondExponent;
  struct Excess {
    double at_fit = 0.0;
    double at_other = 0.0;
    std::size_t curves = 0;
  };
  std::array<Excess, Curves::kPieces> pieces;
  pool.run(Curves::kPieces, [&](int piece) {
    Excess sum;  // not in the array: its pieces share cache lines
    curves.each(piece, [&](const CurveTuple& tuple, const HeightEntry& at) {
      const auto at_fit = excess(tuple, at, first);
      const auto at_other = excess(tuple, at, second);
      if (!at_fit || !at_other) return;
      sum.at_fit += *at_fit;
      sum.at_other += *at_other;
      ++sum.curves;
    });
    pieces[static_cast<std::size_t>(piece)] = sum;
  });
  Excess total;
  for (const Excess& piece : pieces) {
    total.at_fit += piece.at_fit;
    total.at_other += piece.at_other;
    total.curves += piece.curves;
  }
  if (total.curves < kMinCurves) return std::nullopt;
  if (!(total.at_other < total.at_fit)) return std::nullopt;
  return logarithm ? light_exponent(total.at_fit, total.at_other) : heavy_exponent(total.at_fit, total.at_other);
}

}  // namespace

CurveShape curve_shape(std::span<const CurveTuple> tuples, const std::vector<double>& z_um, WorkerPool& pool,
                       bool logarithm) {
  const Curves curves(tuples, z_um);
  const std::optional<double> exponent = exponent_of(curves, pool, logarithm);
  CurveShape shape;
  shape.exponent = exponent.value_or(logarithm ? kGaussianExponent : kFitExponent);

  std::array<std::vector<double>, Curves::kPieces> bends;  // of G over its lowest value
  std::array<std::vector<double>, Curves::kPieces> widths_um;
  pool.run(Curves::kPieces, [&](int piece) {
    auto& bends_here = bends[static_cast<std::size_t>(piece)];
    auto& widths_here = widths_um[static_cast<std::size_t>(piece)];
    const double rise_to_half = std::exp2(1.0 / shape.exponent) - 1.0;
    curves.each(piece, [&](const CurveTuple& tuple, const HeightEntry& at) {
      const auto curve = parabola(tuple, at, shape.exponent);
      if (!curve) return;
      const double bend = curve->bend / curve->lowest();
      bends_here.push_back(bend);
      widths_here.push_back(2.0 * std::sqrt(rise_to_half / bend) * static_cast<double>(at.scale_um));
    });
  });
  auto all_widths_um = joined(widths_um);
  if (all_widths_um.empty()) return shape;
  shape.width_um = median(all_widths_um);
  auto all_bends = joined(bends);
  if (exponent) shape.bias = bias_of_fit(median(all_bends), *exponent, logarithm);
  return shape;
}

}  // namespace fvd
