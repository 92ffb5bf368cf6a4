#pragma once

/// The latest samples of an axis with their times.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/hw/axis.hpp"

namespace fvd {

/// What one poll of the drive said.
struct AxisSample {
  HostTime begun{};  ///< before the first request of the poll was sent
  HostTime time{};   ///< when the drive sampled the position
  Micrometers position;
  bool enabled = false;
  bool homed = false;
  bool moving = false;
  bool in_position = false;
  bool alarm = false;
  int alarm_code = 0;
  bool reference_lost = false;  ///< by that alarm: home again after its reset
  bool limit_positive = false;
  bool limit_negative = false;
  bool emergency_stop = false;
  std::optional<std::int64_t> target{};  ///< steps, as the drive reads it back, where that is polled

  /// As the drive reports it. One without torque may report for ever that it is not in position, which is no motion.
  [[nodiscard]] bool reports_rest() const noexcept { return !moving || !enabled; }
};

/// A ring of fixed size, times increasing. context: one thread at a time.
class PositionLog {
 public:
  explicit PositionLog(std::size_t capacity) : ring_(capacity) {}

  void add(const AxisSample& sample);
  [[nodiscard]] std::optional<AxisSample> latest() const;

  /// Mean and sample standard deviation over [from, to]; interpolated to the window's middle, with 0 samples, from the
  /// nearest neighbours when none lies inside. The log is not empty.
  [[nodiscard]] PositionMean mean(HostTime from, HostTime to) const;

  /// A straight line through the samples of [at - reach, at + reach], read at `at`; sd is that of the samples about it.
  /// With fewer than two samples there it is what mean() says, with 0 samples. The log is not empty.
  [[nodiscard]] PositionMean line(HostTime at, std::chrono::microseconds reach) const;

 private:
  [[nodiscard]] const AxisSample& at(std::size_t age) const;  // 0 = newest

  std::vector<AxisSample> ring_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace fvd
