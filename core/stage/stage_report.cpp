#include "core/stage/stage_report.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/stage/quantile.hpp"

namespace fvd {

namespace {

std::optional<ErrorFigures> error_figures(const std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  const auto n = static_cast<double>(errors.size());
  ErrorFigures figures;
  figures.mean_um = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  double squares = 0.0;
  std::vector<double> magnitudes;
  magnitudes.reserve(errors.size());
  for (const double error : errors) {
    squares += (error - figures.mean_um) * (error - figures.mean_um);
    magnitudes.push_back(std::abs(error));
  }
  if (errors.size() >= 2) figures.sd_um = std::sqrt(squares / (n - 1));
  figures.max_um = *std::max_element(magnitudes.begin(), magnitudes.end());
  figures.p95_um = quantile(std::move(magnitudes), 0.95);
  return figures;
}

template <typename Get>
std::vector<double> collect(const std::vector<StagePoint>& points, Get get) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const StagePoint& point : points) values.push_back(get(point));
  return values;
}

TimeFigures time_figures(const std::vector<double>& times_ms) {
  return {quantile(times_ms, 0.5), quantile(times_ms, 0.95), quantile(times_ms, 1.0)};
}

Span span_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

std::optional<double> known(double length_um) { return length_um > 0.0 ? std::optional(length_um) : std::nullopt; }

std::optional<double> floor_of(const std::optional<double>& step_um) {
  return step_um ? std::optional(*step_um / std::sqrt(12.0)) : std::nullopt;
}

std::vector<double> increment_errors(const std::vector<StagePoint>& points) {
  std::vector<StagePoint> ordered = points;
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const StagePoint& a, const StagePoint& b) { return a.time_s < b.time_s; });
  std::vector<double> errors;
  for (std::size_t i = 1; i < ordered.size(); ++i) {
    const StagePoint& from = ordered[i - 1];
    const StagePoint& to = ordered[i];
    if (from.run != to.run || from.direction != to.direction) continue;
    errors.push_back((to.measured_um - to.quantised_um) - (from.measured_um - from.quantised_um));
  }
  return errors;
}

/// Nothing where all points are at one position.
std::optional<LinearFit> straight_line(const std::vector<StagePoint>& points, const std::vector<double>& error_um,
                                       const std::vector<PositionResponse>& table) {
  if (table.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(points.size());
  double mean_z = 0.0;
  double mean_error = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mean_z += points[i].quantised_um / n;
    mean_error += error_um[i] / n;
  }
  double zz = 0.0;
  double ze = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double z = points[i].quantised_um - mean_z;
    zz += z * z;
    ze += z * (error_um[i] - mean_error);
  }
  const double slope = ze / zz;  // of the error: the response's is 1 more
  LinearFit line;
  line.alpha_z.value = 1.0 + slope;
  line.offset_um = mean_error - slope * mean_z;
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    squares += std::pow(error_um[i] - line.offset_um - slope * points[i].quantised_um, 2);
  }
  line.residual_rms_um = std::sqrt(squares / n);
  if (points.size() > 2) line.alpha_z.standard_error = std::sqrt(squares / (n - 2) / zz);
  for (const auto& response : table) {
    const int visits = response.below.visits + response.above.visits;
    const double mean =
        (response.below.visits * response.below.mean_error_um + response.above.visits * response.above.mean_error_um) /
        visits;
    line.l_z_um = std::max(line.l_z_um, std::abs(mean - line.offset_um - slope * response.quantised_um));
  }
  return line;
}

void say_what_feedback_cannot(StageReport& report) {
  switch (report.feedback) {
    case FeedbackSource::kNone:
      report.caveats.emplace_back("step counting without feedback: the accuracy of the stage is not observable");
      break;
    case FeedbackSource::kMotorEncoder:
      report.caveats.emplace_back(
          "a motor encoder does not see lead error, backlash or thermal growth of the mechanics");
      break;
    case FeedbackSource::kLinearScale:
      break;
  }
}

void judge_range(StageReport& report, const StageReportOptions& options) {
  if (!report.linear || !report.fit->lead) return;
  const double range_um = report.range_um->high - report.range_um->low;
  report.linear->alpha_z_bias_bound =
      alpha_z_bias_bound(report.fit->lead->amplitude_um.value, *options.lead_um, range_um);
  constexpr double kMinRange_leads = 2.997;  // nearly 3: quantisation shortens a range of whole leads
  if (range_um < kMinRange_leads * *options.lead_um) {
    report.caveats.emplace_back(
        "the range is shorter than three screw leads: alpha_z of the straight line is biased by the lead error, by up "
        "to "
        "6 A / (pi lead) over one lead; alpha_z of the fit with the periodic term is not");
  }
}

void measure(StageReport& report, const std::vector<StagePoint>& points, const StageReportOptions& options) {
  const auto errors = collect(points, [](const StagePoint& p) { return p.measured_um - p.quantised_um; });
  report.error = error_figures(errors);
  report.error_to_command =
      error_figures(collect(points, [](const StagePoint& p) { return p.measured_um - p.commanded_um; }));
  report.increment_error = error_figures(increment_errors(points));
  if (points.size() < 2) {
    report.caveats.emplace_back("fewer than two points: no fit, reversal, repeatability or drift");
    return;
  }
  report.linear = straight_line(points, errors, responses(points, errors, options.step_quantum_um));
  report.fit = fit_stage(points, options, report.caveats);
  judge_range(report, options);

  std::vector<double> still = errors;  // drift removed
  for (std::size_t i = 0; i < points.size(); ++i) still[i] -= fitted_drift_um(*report.fit, points[i]);
  const auto table = responses(points, still, options.step_quantum_um);
  report.reversal = reversal_figures(table);
  if (!report.reversal) {
    report.caveats.emplace_back("no position was approached from both sides: the reversal value is not observable");
  }
  report.repeatability = repeatability_figures(table);
  if (!report.repeatability) {
    report.caveats.emplace_back("no position was visited twice from the same side: repeatability is not observable");
  }
}

}  // namespace

StageReport make_stage_report(const std::vector<StagePoint>& points, const StageReportOptions& options) {
  check_stage_points(points, options);
  StageReport report;
  report.n = static_cast<int>(points.size());
  report.feedback = options.feedback;
  report.observable = options.feedback != FeedbackSource::kNone;
  report.step_quantum_um = known(options.step_quantum_um);
  report.step_quantum_floor_um = floor_of(report.step_quantum_um);
  if (report.observable) report.feedback_resolution_um = known(options.feedback_resolution_um);
  report.feedback_floor_um = floor_of(report.feedback_resolution_um);
  say_what_feedback_cannot(report);
  if (points.empty()) {
    report.caveats.emplace_back("there are no points");
    return report;
  }
  report.range_um = span_of(collect(points, [](const StagePoint& p) { return p.quantised_um; }));
  const Span time_s = span_of(collect(points, [](const StagePoint& p) { return p.time_s; }));
  report.duration_min = (time_s.high - time_s.low) / 60.0;
  std::vector<double> temperatures;
  for (const auto& point : points) {
    if (point.temperature_c) temperatures.push_back(*point.temperature_c);
  }
  if (!temperatures.empty()) report.temperature_c = span_of(temperatures);
  report.quantisation =
      error_figures(collect(points, [](const StagePoint& p) { return p.quantised_um - p.commanded_um; }));
  report.settle = time_figures(collect(points, [](const StagePoint& p) { return p.settle_ms; }));
  report.move = time_figures(collect(points, [](const StagePoint& p) { return p.move_ms; }));
  if (report.observable) measure(report, points, options);
  return report;
}

}  // namespace fvd
