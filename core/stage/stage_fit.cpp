#include "core/stage/stage_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "core/stage/design_matrix.hpp"
#include "core/stage/position_response.hpp"

namespace fvd {

namespace {

using Index = Eigen::Index;
constexpr double kPi = std::numbers::pi;
constexpr double kMaxRSquared = 0.99;
constexpr double kMinTemperatureSpan_K = 0.5;  // sensors of drives resolve 0.1 to 1 K
constexpr double kMinRange_leads = 0.999;      // nearly 1: quantisation shortens a range of whole leads
constexpr double kSecondsPerMinute = 60.0;

/// Centred and divided by the span, so that the columns of the fit are of one size.
struct Scaled {
  Eigen::VectorXd values;
  double mean = 0.0;
  double span = 0.0;
};

template <typename Get>
Scaled scaled(const std::vector<StagePoint>& points, Get get) {
  Scaled result;
  result.values.resize(static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.values(static_cast<Index>(i)) = get(points[i]);
  result.mean = result.values.mean();
  result.span = result.values.maxCoeff() - result.values.minCoeff();
  result.values.array() -= result.mean;
  if (result.span > 0.0) result.values /= result.span;
  return result;
}

/// Squared correlation of two centred columns.
double r_squared(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double both = a.squaredNorm() * b.squaredNorm();
  return both > 0.0 ? std::pow(a.dot(b), 2) / both : 0.0;
}

Estimate estimate(const DesignMatrix::Solution& solution, Index column, double scale) {
  Estimate result{solution.coefficients(column) * scale, {}};
  if (solution.covariance.size() > 0) {
    result.standard_error = std::sqrt(std::max(0.0, solution.covariance(column, column))) * std::abs(scale);
  }
  return result;
}

LeadTerm lead_term(const DesignMatrix::Solution& solution, Index sine, Index cosine, double lead_um) {
  const double a = solution.coefficients(sine);
  const double b = solution.coefficients(cosine);
  const double amplitude = std::hypot(a, b);
  LeadTerm term{lead_um, {amplitude, {}}, std::atan2(b, a) * 180.0 / kPi};
  if (term.phase_deg <= -180.0) term.phase_deg += 360.0;
  if (solution.covariance.size() > 0 && amplitude > 0.0) {
    const auto& c = solution.covariance;
    const double variance =
        (a * a * c(sine, sine) + b * b * c(cosine, cosine) + 2 * a * b * c(sine, cosine)) / (amplitude * amplitude);
    term.amplitude_um.standard_error = std::sqrt(std::max(0.0, variance));
  }
  return term;
}

/// Where the terms went in the design; the constant is column 0.
struct Places {
  std::optional<Index> slope, sine, cosine, reversal, time, temperature;
};

void add_lead(DesignMatrix& design, Places& places, const Scaled& z, const std::optional<double>& lead_um,
              std::vector<std::string>& caveats) {
  if (!lead_um) {
    caveats.emplace_back("the screw lead is unknown: a periodic error is not told from noise and can bias alpha_z");
    return;
  }
  if (z.span < kMinRange_leads * *lead_um) {
    caveats.emplace_back("the range is shorter than one screw lead: the lead error is not resolved and biases alpha_z");
    return;
  }
  const Eigen::ArrayXd angle = (z.values.array() * z.span + z.mean) * (2 * kPi / *lead_um);
  DesignMatrix with = design;
  const auto sine = with.add(angle.sin().matrix());
  const auto cosine = with.add(angle.cos().matrix());
  if (sine && cosine) {
    design = with;
    places.sine = sine;
    places.cosine = cosine;
  } else {
    caveats.emplace_back(
        "the positions do not resolve the screw lead: at least three positions a lead, and some more than the fit has "
        "terms, are needed");
  }
}

void add_time(DesignMatrix& design, Places& places, const Scaled& time, std::vector<std::string>& caveats) {
  places.time = design.add(time.values);
  if (!places.time) {
    caveats.emplace_back(
        "drift is not distinguishable: time runs together with position (one pass) or there are too few points; "
        "alpha_z "
        "contains the drift");
  }
}

/// Fits the temperature where it is known, moves enough and moves otherwise than time. True: it moves with time.
bool add_temperature(DesignMatrix& design, Places& places, const Scaled& temperature, const Scaled& time,
                     std::vector<std::string>& caveats) {
  if (temperature.span < kMinTemperatureSpan_K) {
    caveats.emplace_back("the temperature moved by less than 0.5 K: no drift per kelvin");
    return false;
  }
  const bool with_time = r_squared(time.values, temperature.values) > kMaxRSquared;
  if (with_time && places.time) {
    caveats.emplace_back(
        "temperature is collinear with time: the drift per kelvin is the drift rate over the temperature rate, not a "
        "fit of its own");
    return true;
  }
  if (!with_time) places.temperature = design.add(temperature.values);
  if (!places.temperature) {
    caveats.emplace_back("the temperature is not distinguishable from the other terms: no drift per kelvin");
  }
  return false;
}

bool all_have_temperature(const std::vector<StagePoint>& points) {
  return std::all_of(points.begin(), points.end(), [](const StagePoint& p) { return p.temperature_c.has_value(); });
}

}  // namespace

StageFit fit_stage(const std::vector<StagePoint>& points, const StageReportOptions& options,
                   std::vector<std::string>& caveats) {
  const Scaled z = scaled(points, [](const StagePoint& p) { return p.quantised_um; });
  const Scaled time = scaled(points, [](const StagePoint& p) { return p.time_s; });
  const Scaled direction = scaled(points, [](const StagePoint& p) { return static_cast<double>(p.direction); });
  Eigen::VectorXd error(static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    error(static_cast<Index>(i)) = points[i].measured_um - points[i].quantised_um;
  }

  DesignMatrix design(error.size());
  Places places;
  if (z.span > same_position_um(options.step_quantum_um)) places.slope = design.add(z.values);
  if (places.slope) {
    add_lead(design, places, z, options.lead_um, caveats);
  } else {
    caveats.emplace_back("all points are at one position: alpha_z, l_z and the lead error are not observable");
  }
  places.reversal = design.add(direction.values);  // +-1 over its span of 2: the coefficient is the reversal value
  add_time(design, places, time, caveats);
  std::optional<Scaled> temperature;
  bool with_time = false;
  if (all_have_temperature(points)) {
    temperature = scaled(points, [](const StagePoint& p) { return p.temperature_c.value_or(0.0); });
    with_time = add_temperature(design, places, *temperature, time, caveats);
  } else {
    caveats.emplace_back("the temperature is not known for every point: no drift per kelvin");
  }

  const auto solution = design.solve(error);
  StageFit fit;
  const double mean_error =
      solution.coefficients(0) - (places.reversal ? solution.coefficients(*places.reversal) * direction.mean / 2 : 0.0);
  fit.offset_um = mean_error;
  if (places.slope) {
    fit.alpha_z = estimate(solution, *places.slope, 1.0 / z.span);
    fit.offset_um -= fit.alpha_z->value * z.mean;
    fit.alpha_z->value += 1.0;
  }
  if (places.sine) fit.lead = lead_term(solution, *places.sine, *places.cosine, *options.lead_um);
  if (places.reversal) fit.reversal_um = estimate(solution, *places.reversal, 1.0);
  if (places.time) fit.drift_um_per_min = estimate(solution, *places.time, kSecondsPerMinute / time.span);
  if (places.temperature) {
    fit.drift_um_per_k = estimate(solution, *places.temperature, 1.0 / temperature->span);
    fit.mean_temperature_c = temperature->mean;
  } else if (with_time) {
    const double kelvin_per_min = time.values.dot(temperature->values) / time.values.squaredNorm() * temperature->span /
                                  time.span * kSecondsPerMinute;
    fit.drift_um_per_k = Estimate{fit.drift_um_per_min->value / kelvin_per_min, {}};
    if (const auto& rate_error = fit.drift_um_per_min->standard_error) {
      fit.drift_um_per_k->standard_error = *rate_error / std::abs(kelvin_per_min);
    }
    fit.per_kelvin_from_rates = true;
  }
  fit.residual_rms_um = std::sqrt(solution.sum_of_squares / static_cast<double>(points.size()));
  fit.parameters = static_cast<int>(design.columns());
  fit.mean_time_s = time.mean;
  return fit;
}

double fitted_error_um(const StageFit& fit, double quantised_um, int direction) {
  double error = fit.offset_um;
  if (fit.alpha_z) error += (fit.alpha_z->value - 1.0) * quantised_um;
  if (fit.lead) {
    error += fit.lead->amplitude_um.value *
             std::sin(2 * kPi * quantised_um / fit.lead->lead_um + fit.lead->phase_deg * kPi / 180.0);
  }
  if (fit.reversal_um) error += fit.reversal_um->value * direction / 2;
  return error;
}

double fitted_drift_um(const StageFit& fit, const StagePoint& point) {
  double drift = 0.0;
  if (fit.drift_um_per_min) drift += fit.drift_um_per_min->value * (point.time_s - fit.mean_time_s) / kSecondsPerMinute;
  if (fit.drift_um_per_k && !fit.per_kelvin_from_rates && point.temperature_c) {
    drift += fit.drift_um_per_k->value * (*point.temperature_c - fit.mean_temperature_c);
  }
  return drift;
}

double alpha_z_bias_bound(double amplitude_um, double lead_um, double range_um) {
  const double k = 2 * kPi / lead_um;
  const double half = k * range_um / 2;
  return 12 * amplitude_um / std::pow(range_um, 3) *
         std::abs(2 * std::sin(half) / (k * k) - range_um * std::cos(half) / k);
}

}  // namespace fvd
