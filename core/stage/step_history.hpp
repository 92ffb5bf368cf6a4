#pragma once

/// The step errors of all scans so far, in constant memory: for a daemon that runs for years.

#include <cstdint>
#include <optional>

#include "core/hw/axis.hpp"
#include "core/stage/magnitude_histogram.hpp"
#include "core/stage/running_moments.hpp"
#include "core/stage/step_log.hpp"

namespace fvd {

/// The whole state of a history, to be stored and restored. Lengths in um, times in ms.
struct StepHistoryState {
  FeedbackSource feedback = FeedbackSource::kNone;
  std::uint64_t scans = 0;
  std::uint64_t steps = 0;         ///< measured slices
  std::uint64_t lost_steps = 0;    ///< slices that were lost as the recipe allowed
  RunningMoments error;            ///< measured - quantised
  MagnitudeHistogram error_sizes;  ///< |error|
  RunningMoments increment_error;  ///< measured - quantised distance of neighbouring measured slices of a scan
  RunningMoments move;             ///< start of the move to settled
  MagnitudeHistogram move_times;
};

struct StepHistorySummary {
  std::uint64_t scans = 0;
  std::uint64_t steps = 0;
  std::uint64_t lost_steps = 0;
  bool observable = false;  ///< false: no feedback, every error is empty
  std::optional<double> error_mean_um, error_sd_um, error_max_um;
  std::optional<double> error_p95_um;  ///< of |error|, within 2.2 % (MagnitudeHistogram), never above error_max_um
  std::optional<double> increment_error_mean_um, increment_error_sd_um, increment_error_max_um;
  std::optional<double> move_p50_ms, move_p95_ms;  ///< within 2.2 %, never above move_max_ms
  std::optional<double> move_max_ms;
};

/// context: one thread at a time.
class StepHistory {
 public:
  /// A history belongs to one kind of feedback. With kNone the errors of the logs are not measured and are left out.
  explicit StepHistory(FeedbackSource feedback) { state_.feedback = feedback; }
  /// Throws Error kBadInput for a state that no scans can have led to.
  explicit StepHistory(const StepHistoryState& state);

  /// Adds one scan, all of it or nothing. Throws Error kBadInput naming the slice with a value that is not finite or a
  /// negative time: one such value would spoil the history for ever.
  void add(const StepLog& log);

  /// As if the other's scans had been added here. Throws Error kBadInput for another kind of feedback.
  void merge(const StepHistory& other);

  [[nodiscard]] const StepHistoryState& state() const noexcept { return state_; }
  [[nodiscard]] StepHistorySummary summary() const;

 private:
  StepHistoryState state_;
};

}  // namespace fvd
