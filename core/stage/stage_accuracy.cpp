#include "core/stage/stage_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace fvd {

namespace {

using Values = Eigen::Map<const Eigen::ArrayXd>;

Values values_of(const std::vector<double>& list) { return {list.data(), static_cast<Eigen::Index>(list.size())}; }

double sample_sd(const Values& values) {
  if (values.size() < 2) return 0.0;
  return std::sqrt((values - values.mean()).square().sum() / static_cast<double>(values.size() - 1));
}

double largest_magnitude(const Values& values) { return values.size() == 0 ? 0.0 : values.abs().maxCoeff(); }

}  // namespace

StepSummary summarize_steps(const StepLog& log) {
  std::vector<double> errors;
  std::vector<double> increment_errors;
  std::vector<double> moves;
  const StepRecord* previous = nullptr;
  for (const StepRecord& step : log) {
    if (!step.measured) {
      previous = nullptr;  // an increment across a lost slice is not one step of the stage
      continue;
    }
    errors.push_back(step.error_um);
    moves.push_back(step.move_ms);
    if (previous != nullptr) increment_errors.push_back(step.error_um - previous->error_um);
    previous = &step;
  }
  StepSummary summary;
  if (errors.empty()) return summary;
  summary.steps = static_cast<int>(errors.size());
  summary.error_mean_um = values_of(errors).mean();
  summary.error_sd_um = sample_sd(values_of(errors));
  summary.error_max_um = largest_magnitude(values_of(errors));
  summary.increment_error_sd_um = sample_sd(values_of(increment_errors));
  summary.increment_error_max_um = largest_magnitude(values_of(increment_errors));
  std::sort(moves.begin(), moves.end());
  summary.move_max_ms = moves.back();
  const std::size_t middle = moves.size() / 2;
  summary.move_median_ms = moves.size() % 2 == 1 ? moves[middle] : (moves[middle - 1] + moves[middle]) / 2;
  return summary;
}

}  // namespace fvd
