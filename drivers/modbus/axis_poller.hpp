#pragma once

/// Samples a drive for as long as it lives: fast while somebody needs it, slowly else.

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "drivers/modbus/drive_profile.hpp"
#include "drivers/modbus/modbus_link.hpp"
#include "drivers/modbus/position_log.hpp"

namespace fvd {

/// A drive that stops answering is lost for good: if it moved it is told to stop, once, and everything throws
/// kStageDisconnected from then on. A position the axis cannot have reached since the last sample is read again before
/// it is believed. context: thread-safe.
class AxisPoller {
 public:
  /// Takes the first sample. max_speed_um_per_s: what the axis is commanded to; homing may be as fast. The others
  /// outlive the poller. Throws Error kStageDisconnected.
  AxisPoller(ModbusLink& link, const DriveProfile& profile, double max_speed_um_per_s);
  ~AxisPoller();
  AxisPoller(const AxisPoller&) = delete;
  AxisPoller& operator=(const AxisPoller&) = delete;

  /// The first sample that was taken wholly after `after`. Throws Error kStageDisconnected, kAborted on a stop request.
  [[nodiscard]] AxisSample sample_after(HostTime after, std::stop_token stop);
  [[nodiscard]] PositionMean mean(HostTime from, HostTime to);
  [[nodiscard]] PositionMean line(HostTime at, std::chrono::microseconds reach);
  [[nodiscard]] std::vector<StageTemperature> temperatures() const;
  /// No samples are taken while the lock is held: on a slow line they would come between the frames of a start.
  [[nodiscard]] std::unique_lock<std::mutex> pause() { return std::unique_lock(polling_); }
  /// For drives that have no bit that says so.
  void remember_homed(bool homed) noexcept { homed_ = homed; }
  [[nodiscard]] bool connected() const noexcept { return connected_; }
  [[nodiscard]] std::uint64_t implausible() const noexcept { return implausible_; }

 private:
  void run(std::stop_token stop);
  void poll_once();
  std::optional<AxisSample> read_sample(std::string& error);
  [[nodiscard]] bool plausible(const AxisSample& sample) const;
  void lose(const std::string& error);
  void read_temperatures();

  ModbusLink& link_;
  const DriveProfile& profile_;
  const double max_speed_um_per_s_;
  std::mutex polling_;  // held for the length of a poll
  mutable std::mutex mutex_;
  std::condition_variable_any sampled_;
  std::condition_variable_any wake_;
  PositionLog log_;  // guarded by mutex_, as is all up to temperatures_
  HostTime fast_until_{};
  std::string loss_;
  std::vector<StageTemperature> temperatures_;
  HostTime temperatures_read_{};  // poller only
  std::atomic<bool> connected_{true};
  std::atomic<bool> homed_{false};
  std::atomic<std::uint64_t> implausible_{0};
  std::jthread thread_;  // last
};

}  // namespace fvd
