#pragma once

/// Samples an axis for as long as it lives: fast while somebody needs it, slowly otherwise.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "core/base/mutex.hpp"
#include "drivers/common/axis_port.hpp"
#include "drivers/common/position_log.hpp"

namespace fvd {

/// A controller that stops answering is lost for good: everything throws kStageDisconnected from then on, and if the
/// axis moved it is told to stop, once. A position that the axis cannot have reached since the last sample is
/// believed when another reading agrees, or lies further on the same way; so is a first one far outside the limits.
/// Five that contradict one another are a loss. What another master writes is looked for five times a second. context:
/// thread-safe.
class AxisPoller {
 public:
  /// Takes the first sample. max_speed_um_per_s: what the axis is commanded to; homing may be faster. min, max: the
  /// axis' limits. The port outlives the poller. Throws Error kStageDisconnected.
  AxisPoller(AxisPort& port, double max_speed_um_per_s, Micrometers min, Micrometers max);
  AxisPoller(const AxisPoller&) = delete;
  AxisPoller& operator=(const AxisPoller&) = delete;

  /// The first sample that was begun after `after`. Throws Error kStageDisconnected, also if no sample came until
  /// `deadline` (by default the port's sample_timeout after `after`), kAborted on a stop request.
  [[nodiscard]] AxisSample sample_after(HostTime after, std::stop_token stop);
  [[nodiscard]] AxisSample sample_after(HostTime after, std::stop_token stop, HostTime deadline);

  /// One that is begun now, without the pause between two samples. Throws as sample_after().
  [[nodiscard]] AxisSample sample_now(std::stop_token stop);

  /// The latest sample, whatever its age. Throws nothing.
  [[nodiscard]] AxisSample latest() const;
  [[nodiscard]] PositionMean mean(HostTime from, HostTime to) const;
  [[nodiscard]] PositionMean line(HostTime at, std::chrono::microseconds reach) const;
  [[nodiscard]] std::vector<StageTemperature> temperatures() const;

  /// What another master wrote within the last ten seconds. look: looks now, too; a stop request ends
  /// the patience with a busy drive.
  [[nodiscard]] std::optional<ForeignWrite> foreign_write(bool look, const std::stop_token& stop = {});
  void forget_foreign_write();

  /// Runs the action between two samples: on a slow line they would come between the frames of a start.
  void pause(const std::function<void()>& action);
  /// For controllers that do not tell.
  void remember_homed(bool homed) noexcept { homed_ = homed; }
  [[nodiscard]] bool connected() const noexcept;
  [[nodiscard]] std::uint64_t implausible() const noexcept { return implausible_; }

 private:
  void run(const std::stop_token& stop);
  void poll_once() FVD_REQUIRES(polling_);
  [[nodiscard]] std::optional<AxisSample> read_sample(std::string& error);
  /// The axis, as fast as it may move, comes from one to the other in the time between.
  [[nodiscard]] bool reachable(const AxisSample& from, const AxisSample& to) const;
  /// False, and nothing is published, if the axis cannot have come there from the sample before nor from `doubtful`.
  [[nodiscard]] bool publish(const AxisSample& sample, const std::optional<AxisSample>& doubtful);
  /// Publishes the loss and returns whether the axis moved when it was last seen.
  bool lose(const std::string& error);
  void stop_lost_axis() noexcept;
  void read_temperatures() FVD_REQUIRES(polling_);
  void look_for_others(const std::stop_token& stop) FVD_REQUIRES(polling_);
  [[nodiscard]] bool far_outside(const AxisSample& sample) const;

  AxisPort& port_;
  const double max_speed_um_per_s_;
  const Micrometers min_;
  const Micrometers max_;
  Mutex polling_;  // held for the length of a poll; taken before mutex_
  mutable Mutex mutex_;
  Condition sampled_;
  Condition wake_;
  PositionLog log_ FVD_GUARDED_BY(mutex_);
  HostTime fast_until_ FVD_GUARDED_BY(mutex_){};
  bool asked_ FVD_GUARDED_BY(mutex_) = false;  ///< by sample_now()
  bool connected_ FVD_GUARDED_BY(mutex_) = true;
  std::string loss_ FVD_GUARDED_BY(mutex_);
  std::vector<StageTemperature> temperatures_ FVD_GUARDED_BY(mutex_);
  std::optional<ForeignWrite> foreign_ FVD_GUARDED_BY(mutex_);
  HostTime foreign_seen_ FVD_GUARDED_BY(mutex_){};
  HostTime temperatures_read_ FVD_GUARDED_BY(polling_){};
  HostTime others_looked_for_ FVD_GUARDED_BY(polling_){};
  std::atomic<bool> homed_{false};
  std::atomic<std::uint64_t> implausible_{0};
  std::jthread thread_;  // last
};

}  // namespace fvd
