#include "core/focus/fit/gap_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Cholesky>

#include "core/base/units.hpp"
#include "core/focus/fit/fit_reference.hpp"
#include "core/focus/fit/sample_heights.hpp"

namespace fvd {

namespace {

/// Samples this far from their places, in steps, are too far to be moved there.
constexpr double kMostOutOfPlace_steps = 0.15;
constexpr std::size_t kMostCurves = 4000;
constexpr std::size_t kLeastCurves = 500;
/// Each fifth of a step must have this share of their vertices: curves that all peak at the same place between two
/// samples, as those of a plateau, would teach that every curve does.
constexpr double kLeastShareOfFifth = 0.05;
/// Nothing is learnt from shares further from their mean, in standard deviations.
constexpr double kMostDeviations = 4.0;
/// Each share may be a usual one and all three together not: of curves whose width is not the scan's. From the first
/// strangeness to the second the five-sample fit takes over. Of the scan's own curves a tenth is beyond the first.
constexpr double kUsual = 2.0;
constexpr double kStrange = 5.0;
/// From the first to the second, in steps towards the gap, the five-sample fit takes over: nearer to the gap's middle
/// it has samples on both sides that tell as much. Past half a step the missing sample would have been the peak.
constexpr double kFitBegins_steps = 0.3;
constexpr double kFitAlone_steps = 0.5;
constexpr double kMostChange_steps = 0.25;
constexpr double kRidge = 1e-6;  // keeps terms that a scan's curves do not tell apart small

ReferenceSample sample(const CurveTuple& curve, const std::vector<double>& z_um, int from_peak) {
  return {z_um[static_cast<std::size_t>(curve.index + from_peak)],
          static_cast<double>(curve.share[static_cast<std::size_t>(2 + from_peak)])};
}

bool cover_a_step(const std::vector<double>& vertices_steps) {
  std::array<std::size_t, 5> fifths{};
  for (const double vertex : vertices_steps)
    ++fifths[static_cast<std::size_t>(std::clamp(5.0 * (vertex + 0.5), 0.0, 4.9))];
  const double least = kLeastShareOfFifth * static_cast<double>(vertices_steps.size());
  return static_cast<double>(*std::min_element(fifths.begin(), fifths.end())) >= least;
}

}  // namespace

GapFit::GapFit(std::span<const CurveTuple> tuples, const std::vector<double>& z_um, const CurveShape& shape,
               const CurveLimits& limits)
    : z_um_(z_um), model_(shape), towards_gap_(z_um.size()) {
  if (!(shape.width_um > 0.0)) return;
  step_um_ = median_step_um(z_um) * (z_um.back() < z_um.front() ? -1.0 : 1.0);
  if (step_um_ == 0.0) return;
  std::array<bool, 2> gaps{};
  for (int i = 0; i < static_cast<int>(z_um.size()); ++i) {
    const bool before = in_place(i, -1, 2);
    const bool after = in_place(i, 1, 2);
    if (before == after) continue;
    towards_gap_[static_cast<std::size_t>(i)] = static_cast<std::int8_t>(after ? 1 : -1);
    gaps[after ? 1 : 0] = true;
  }
  for (std::size_t side = 0; side < gaps.size(); ++side) {
    if (gaps[side]) polynomials_[side] = learn(tuples, shape, limits, side == 1 ? 1 : -1);
    any_ = any_ || polynomials_[side].has_value();
  }
}

/// Two samples on the side away from the gap, and one `beyond` steps away on the other, which is the next there.
bool GapFit::in_place(int index, int towards, int beyond) const noexcept {
  const auto steps = [&](int from_peak) {
    const int k = index + from_peak;
    if (k < 0 || k >= static_cast<int>(z_um_.size())) return 1e9;
    return (z_um_[static_cast<std::size_t>(k)] - z_um_[static_cast<std::size_t>(index)]) / step_um_ * towards;
  };
  const auto near = [](double value, double place) { return std::abs(value - place) < kMostOutOfPlace_steps; };
  return near(steps(-towards), -1.0) && near(steps(-2 * towards), -2.0) && near(steps(towards), beyond);
}

GapFit::Three GapFit::shares_in_place(const CurveTuple& curve, int towards, int beyond,
                                      double height_um) const noexcept {
  const double peak_um = z_um_[static_cast<std::size_t>(curve.index)];
  const auto moved = [&](int from_peak, int place) {
    const ReferenceSample found = sample(curve, z_um_, from_peak);
    const double place_um = peak_um + step_um_ * place;
    return found.share * model_.ratio(place_um - height_um, found.z_um - height_um);
  };
  return {moved(-2 * towards, -2 * towards), moved(-towards, -towards),
          moved(beyond == 2 ? towards : 2 * towards, 2 * towards)};
}

GapFit::Terms GapFit::terms(const Three& x) noexcept {
  const auto [a, b, c] = x;
  return {1.0,       a,         b,         c,         a * a,     a * b,     a * c,     b * b,     b * c,     c * c,
          a * a * a, a * a * b, a * a * c, a * b * b, a * b * c, a * c * c, b * b * b, b * b * c, b * c * c, c * c * c};
}

double GapFit::strangeness(const Terms& terms, const Polynomial& polynomial) noexcept {
  using Square = Eigen::Map<const Eigen::Matrix<double, kTerms, kTerms>>;
  using Column = Eigen::Map<const Eigen::Matrix<double, kTerms, 1>>;
  const Eigen::Matrix<double, kTerms, 1> white = Square(polynomial.whitening.front().data()) * Column(terms.data());
  return white.squaredNorm();
}

std::optional<GapFit::Polynomial> GapFit::learn(std::span<const CurveTuple> tuples, const CurveShape& shape,
                                                const CurveLimits& limits, int towards) const {
  std::vector<Three> shares;
  std::vector<double> vertices_steps;
  const std::size_t count = std::min(tuples.size(), kMostCurves);
  for (std::size_t i = 0; i < count; ++i) {
    const CurveTuple& curve = tuples[count == tuples.size() ? i : spread_index(i, tuples.size())];
    const auto beyond = static_cast<std::size_t>(2 + 2 * towards);
    if (!in_place(curve.index, towards, 1) || !in_place(curve.index, -towards, 1)) continue;
    const auto near = static_cast<double>(curve.share[1]) + static_cast<double>(curve.share[3]);
    if (near < limits.neighbours(std::abs(step_um_)) || !(curve.share[beyond] > 0.0F)) continue;
    const auto at = [&](int from_peak) { return sample(curve, z_um_, from_peak); };
    const auto peak = fit_reference(
        {.peak = at(0), .left = at(-1), .right = at(1), .left2 = at(-2), .right2 = at(2), .bias = shape.bias});
    if (!peak) continue;
    shares.push_back(shares_in_place(curve, towards, 1, peak->z_um));
    vertices_steps.push_back((peak->z_um - at(0).z_um) / step_um_ * towards);
  }
  if (shares.size() < kLeastCurves || !cover_a_step(vertices_steps)) return std::nullopt;
  using Column = Eigen::Map<const Eigen::Matrix<double, kTerms, 1>>;
  Polynomial result;
  const auto n = static_cast<double>(shares.size());
  for (std::size_t j = 0; j < result.mean.size(); ++j) {
    double sum = 0.0;
    for (const Three& x : shares) sum += x[j];
    result.mean[j] = sum / n;
    double squares = 0.0;
    for (const Three& x : shares) squares += (x[j] - result.mean[j]) * (x[j] - result.mean[j]);
    result.sd[j] = std::sqrt(squares / n);
    if (!(result.sd[j] > 0.0)) return std::nullopt;
  }
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Identity() * (kRidge * n);
  Eigen::Matrix<double, kTerms, 1> sums = Eigen::Matrix<double, kTerms, 1>::Zero();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    Three x = shares[i];
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = (x[j] - result.mean[j]) / result.sd[j];
    if (std::any_of(x.begin(), x.end(), [](double value) { return std::abs(value) > kMostDeviations; })) continue;
    const Terms all = terms(x);
    const Column row(all.data());
    normal += row * row.transpose();
    sums += row * vertices_steps[i];
  }
  const Eigen::LLT<Eigen::Matrix<double, kTerms, kTerms>> factor(normal);
  if (factor.info() != Eigen::Success) return std::nullopt;
  Eigen::Map<Eigen::Matrix<double, kTerms, 1>>(result.factors.data()) = factor.solve(sums);
  using Square = Eigen::Matrix<double, kTerms, kTerms>;
  Square whitening = Square::Identity() * std::sqrt(n / kTerms);
  factor.matrixL().solveInPlace(whitening);
  Eigen::Map<Square>(result.whitening.front().data()) = whitening;
  return result;
}

double GapFit::height_um(const CurveTuple& curve) const noexcept {
  const auto index = static_cast<std::size_t>(curve.index);
  const int towards = towards_gap_[index];
  const auto fitted_um = static_cast<double>(curve.height_um);
  if (towards == 0) return fitted_um;
  const auto& polynomial = polynomials_[towards > 0 ? 1 : 0];
  if (!polynomial) return fitted_um;
  const double fitted_steps = (fitted_um - z_um_[index]) / step_um_ * towards;
  if (!(fitted_steps < kFitAlone_steps)) return fitted_um;
  Three x = shares_in_place(curve, towards, 2, fitted_um);
  for (std::size_t j = 0; j < x.size(); ++j) x[j] = (x[j] - polynomial->mean[j]) / polynomial->sd[j];
  const Terms all = terms(x);
  const double strange = strangeness(all, *polynomial);
  if (!(strange < kStrange)) return fitted_um;
  const double vertex_steps = std::inner_product(all.begin(), all.end(), polynomial->factors.begin(), 0.0);
  const double change = vertex_steps - fitted_steps;
  const double usual = std::min(1.0, (kStrange - strange) / (kStrange - kUsual));
  const double share = usual * std::min(1.0, (kFitAlone_steps - fitted_steps) / (kFitAlone_steps - kFitBegins_steps));
  return fitted_um + share * std::clamp(change, -kMostChange_steps, kMostChange_steps) * step_um_ * towards;
}

void GapFit::correct(const RowFit& fit, const CurveRow& row, int width, float* height_m) const noexcept {
  if (!any_) return;
  for (int x = 0; x < width; ++x) {
    if (towards_gap_[row.peak_index[x]] == 0 || std::isnan(height_m[x])) continue;
    CurveTuple curve{.index = row.peak_index[x], .share = fit.shares(row, x)};
    curve.height_um = height_m[x] * 1e6F;
    height_m[x] = static_cast<float>(height_um(curve) * kMetresPerMicrometer);
  }
}

}  // namespace fvd
