#pragma once

/// A stage that arrives at once and keeps the history of its positions, with which a camera's frames are checked.

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/hw/axis.hpp"

namespace fvd::test {

/// context: z_um() thread-safe, the rest as an Axis.
class TimedStage final : public Axis {
 public:
  [[nodiscard]] StageInfo info() const override {
    return {.name = "timed stage",
            .address = "in process",
            .feedback = FeedbackSource::kLinearScale,
            .step_quantum = Micrometers{0.001},
            .feedback_resolution = Micrometers{0.001},
            .min = Micrometers{-1e6},
            .max = Micrometers{1e6},
            .take_up = Micrometers{0.0},
            .simulated = true};
  }
  [[nodiscard]] StageStatus status() override {
    StageStatus status;
    status.enabled = status.homed = status.in_position = true;
    status.position = Micrometers{z_um(HostClock::now())};
    return status;
  }
  void home(std::stop_token /*stop*/) override {}

  MoveRecord move_to(Micrometers target, const SettleCriterion& /*criterion*/, std::stop_token stop) override {
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the timed stage was stopped");
    MoveRecord move;
    move.started = HostClock::now();
    {
      const std::lock_guard lock(mutex_);
      history_.emplace_back(move.started, target.value);
    }
    move.target = move.target_quantised = move.position = target;
    move.halted = move.settled = HostClock::now();
    move.polls = 1;
    return move;
  }
  MoveRecord sweep_to(Micrometers target, double /*speed_um_per_s*/, std::stop_token stop) override {
    return move_to(target, {}, stop);
  }
  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override {
    return {Micrometers{(z_um(from) + z_um(to)) / 2}, Micrometers{0.0}, 2};
  }
  [[nodiscard]] PositionMean position_at(HostTime at, std::chrono::microseconds /*reach*/) override {
    return {Micrometers{z_um(at)}, Micrometers{0.0}, 1};
  }
  void stop() noexcept override {}
  [[nodiscard]] bool connected() const noexcept override { return true; }

  /// Position at a time, um.
  [[nodiscard]] double z_um(HostTime at) const {
    const std::lock_guard lock(mutex_);
    const auto after = std::upper_bound(history_.begin(), history_.end(), at,
                                        [](HostTime time, const auto& entry) { return time < entry.first; });
    return after == history_.begin() ? 0.0 : std::prev(after)->second;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<HostTime, double>> history_;  // guarded by mutex_
};

}  // namespace fvd::test
