#include "core/stage/step_history.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.hpp"

namespace fvd {

namespace {

void check(const StepLog& log) {
  for (const StepRecord& step : log) {
    if (!step.measured) continue;
    if (std::isfinite(step.error_um) && std::isfinite(step.move_ms) && step.move_ms >= 0.0) continue;
    throw Error(ErrorCode::kBadInput,
                "step history: slice " + std::to_string(step.index) + " has an error or move time that cannot be used");
  }
}

std::optional<double> at_most(std::optional<double> value, double limit) {
  return value ? std::optional(std::min(*value, limit)) : std::nullopt;
}

}  // namespace

StepHistory::StepHistory(const StepHistoryState& state) : state_(state) {
  const bool observable = state.feedback != FeedbackSource::kNone;
  const bool good = state.error.consistent() && state.increment_error.consistent() && state.move.consistent() &&
                    state.move.n == state.steps && state.move_times.total() == state.steps &&
                    state.error.n == (observable ? state.steps : 0) && state.error_sizes.total() == state.error.n &&
                    state.increment_error.n <= state.error.n && (state.scans > 0 || state.steps == 0);
  if (!good) throw Error(ErrorCode::kBadInput, "step history: the stored state contradicts itself");
}

void StepHistory::add(const StepLog& log) {
  check(log);
  const bool observable = state_.feedback != FeedbackSource::kNone;
  const StepRecord* previous = nullptr;
  for (const StepRecord& step : log) {
    if (!step.measured) {
      ++state_.lost_steps;
      previous = nullptr;  // an increment across a lost slice is not one step of the stage
      continue;
    }
    ++state_.steps;
    state_.move.add(step.move_ms);
    state_.move_times.add(step.move_ms);
    if (!observable) continue;
    state_.error.add(step.error_um);
    state_.error_sizes.add(std::abs(step.error_um));
    if (previous != nullptr) state_.increment_error.add(step.error_um - previous->error_um);
    previous = &step;
  }
  ++state_.scans;
}

void StepHistory::merge(const StepHistory& other) {
  if (other.state_.feedback != state_.feedback) {
    throw Error(ErrorCode::kBadInput, "step history: histories of different feedback do not add up");
  }
  state_.scans += other.state_.scans;
  state_.steps += other.state_.steps;
  state_.lost_steps += other.state_.lost_steps;
  state_.error.merge(other.state_.error);
  state_.error_sizes.merge(other.state_.error_sizes);
  state_.increment_error.merge(other.state_.increment_error);
  state_.move.merge(other.state_.move);
  state_.move_times.merge(other.state_.move_times);
}

StepHistorySummary StepHistory::summary() const {
  StepHistorySummary summary;
  summary.scans = state_.scans;
  summary.steps = state_.steps;
  summary.lost_steps = state_.lost_steps;
  summary.observable = state_.feedback != FeedbackSource::kNone;
  if (const RunningMoments& error = state_.error; error.n > 0) {
    summary.error_mean_um = error.mean;
    summary.error_sd_um = error.sd();
    summary.error_max_um = error.max_magnitude;
    summary.error_p95_um = at_most(state_.error_sizes.quantile(0.95), error.max_magnitude);
  }
  if (const RunningMoments& increment = state_.increment_error; increment.n > 0) {
    summary.increment_error_mean_um = increment.mean;
    summary.increment_error_sd_um = increment.sd();
    summary.increment_error_max_um = increment.max_magnitude;
  }
  if (const RunningMoments& move = state_.move; move.n > 0) {
    summary.move_p50_ms = at_most(state_.move_times.quantile(0.5), move.max_magnitude);
    summary.move_p95_ms = at_most(state_.move_times.quantile(0.95), move.max_magnitude);
    summary.move_max_ms = move.max_magnitude;
  }
  return summary;
}

}  // namespace fvd
