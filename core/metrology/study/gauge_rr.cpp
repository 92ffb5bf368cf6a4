#include "core/metrology/study/gauge_rr.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <boost/math/distributions/fisher_f.hpp>

#include "core/base/error.hpp"

namespace fvd::metrology {
namespace {

void check(std::span<const double> values, const GaugeRrSettings& settings) {
  if (settings.parts < 2 || settings.operators < 1 || settings.trials < 2) {
    throw Error(ErrorCode::kBadInput, "a gauge study needs at least 2 parts, 1 operator and 2 trials");
  }
  const std::size_t expected = static_cast<std::size_t>(settings.parts) * static_cast<std::size_t>(settings.operators) *
                               static_cast<std::size_t>(settings.trials);
  if (values.size() != expected) {
    throw Error(ErrorCode::kBadInput, "a gauge study of this size has " + std::to_string(expected) + " values, not " +
                                          std::to_string(values.size()));
  }
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) {
    throw Error(ErrorCode::kBadInput, "a gauge study takes finite values only");
  }
  if (!(settings.pooling_p >= 0.0 && settings.pooling_p <= 1.0) || !(settings.spread_sd > 0.0) ||
      (settings.tolerance && !(*settings.tolerance > 0.0))) {
    throw Error(ErrorCode::kBadInput, "tolerance, spread or the limit of pooling of a gauge study is out of range");
  }
}

/// A sum of squares with its degrees of freedom.
struct Source {
  double squares = 0.0;
  double dof = 0.0;
  [[nodiscard]] double mean() const { return dof > 0.0 ? squares / dof : 0.0; }
};

struct Table {
  Source parts;
  Source operators;
  Source interaction;
  Source trials;
};

/// Means over the values whose indices are not fixed (-1), less the first value, which keeps rounding small.
class Means {
 public:
  Means(std::span<const double> values, const GaugeRrSettings& settings) : values_(values), settings_(settings) {}

  [[nodiscard]] double value(int part, int person, int trial) const {
    const int index = (part * settings_.operators + person) * settings_.trials + trial;
    return values_[static_cast<std::size_t>(index)] - values_.front();
  }
  [[nodiscard]] double cell(int part, int person) const {
    const double first = value(part, person, 0);
    double sum = 0.0;
    for (int trial = 0; trial < settings_.trials; ++trial) sum += value(part, person, trial) - first;
    return first + sum / settings_.trials;
  }
  [[nodiscard]] double part(int part) const {
    double sum = 0.0;
    for (int person = 0; person < settings_.operators; ++person) sum += cell(part, person);
    return sum / settings_.operators;
  }
  [[nodiscard]] double person(int person) const {
    double sum = 0.0;
    for (int part = 0; part < settings_.parts; ++part) sum += cell(part, person);
    return sum / settings_.parts;
  }
  [[nodiscard]] double all() const {
    double sum = 0.0;
    for (int one = 0; one < settings_.parts; ++one) sum += part(one);
    return sum / settings_.parts;
  }

 private:
  std::span<const double> values_;
  const GaugeRrSettings& settings_;
};

/// Sums of squares that are rounding alone become 0, so that they are not compared with each other.
void drop_rounding(Table& table, std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * largest;
  const double floor = static_cast<double>(values.size()) * rounding * rounding;
  for (Source* source : {&table.parts, &table.operators, &table.interaction, &table.trials}) {
    if (source->squares <= floor) source->squares = 0.0;
  }
}

Table analysis(std::span<const double> values, const GaugeRrSettings& settings) {
  const Means means(values, settings);
  const double parts = settings.parts;
  const double operators = settings.operators;
  const double trials = settings.trials;
  const double all = means.all();
  Table table;
  table.parts.dof = parts - 1.0;
  table.operators.dof = operators - 1.0;
  table.interaction.dof = (parts - 1.0) * (operators - 1.0);
  table.trials.dof = parts * operators * (trials - 1.0);
  for (int person = 0; person < settings.operators; ++person) {
    table.operators.squares += parts * trials * std::pow(means.person(person) - all, 2);
  }
  for (int part = 0; part < settings.parts; ++part) {
    const double of_part = means.part(part);
    table.parts.squares += operators * trials * std::pow(of_part - all, 2);
    for (int person = 0; person < settings.operators; ++person) {
      const double cell = means.cell(part, person);
      table.interaction.squares += trials * std::pow(cell - of_part - means.person(person) + all, 2);
      for (int trial = 0; trial < settings.trials; ++trial) {
        table.trials.squares += std::pow(means.value(part, person, trial) - cell, 2);
      }
    }
  }
  drop_rounding(table, values);
  return table;
}

/// Of the F test of the interaction against the trials.
double interaction_p(const Table& table) {
  if (table.interaction.squares == 0.0) return 1.0;
  if (table.trials.squares == 0.0) return 0.0;
  const boost::math::fisher_f_distribution<double> distribution(table.interaction.dof, table.trials.dof);
  return boost::math::cdf(boost::math::complement(distribution, table.interaction.mean() / table.trials.mean()));
}

double root(double variance) { return std::sqrt(std::max(0.0, variance)); }

void set_components(GaugeRr& study, const Table& table, const GaugeRrSettings& settings) {
  const double parts = settings.parts;
  const double operators = settings.operators;
  const double trials = settings.trials;
  double repeatability = table.trials.mean();
  double error_of_means = repeatability;  // what the means of parts and of operators scatter by anyway
  if (settings.operators > 1) {
    study.interaction_p = interaction_p(table);
    study.interaction_pooled = *study.interaction_p > settings.pooling_p;
    if (study.interaction_pooled) {
      repeatability = (table.interaction.squares + table.trials.squares) / (table.interaction.dof + table.trials.dof);
      error_of_means = repeatability;
    } else {
      error_of_means = table.interaction.mean();
      study.interaction = root((error_of_means - repeatability) / trials);
    }
    study.av = root((table.operators.mean() - error_of_means) / (parts * trials));
  }
  study.ev = root(repeatability);
  study.pv = root((table.parts.mean() - error_of_means) / (operators * trials));
}

}  // namespace

GaugeRr gauge_rr(std::span<const double> values, const GaugeRrSettings& settings) {
  check(values, settings);
  GaugeRr study;
  set_components(study, analysis(values, settings), settings);
  study.grr = std::hypot(study.ev, study.av, study.interaction);
  study.tv = std::hypot(study.grr, study.pv);
  if (study.tv > 0.0) study.grr_of_total_percent = 100.0 * study.grr / study.tv;
  if (settings.tolerance) {
    study.grr_of_tolerance_percent = 100.0 * settings.spread_sd * study.grr / *settings.tolerance;
  }
  if (study.grr > 0.0) {
    const double categories = std::floor(1.41 * study.pv / study.grr);
    study.ndc = static_cast<int>(std::min(categories, 1e9));
  }
  return study;
}

}  // namespace fvd::metrology
