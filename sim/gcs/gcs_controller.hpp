#pragma once

/// A simulated controller by Physik Instrumente with one axis: GCS 2.0 as text, independent of the line.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "sim/axis/axis_model.hpp"

namespace fvd::sim {

/// Understands SVO, SVO?, MOV, VEL, ACC, DEC, FRF, FRF?, POS?, ONT?, TMN?, TMX?, HLT, STP, ERR?, SAI?, *IDN? and the
/// single characters #5 (motion status) and #24 (stop). context: thread-safe.
class GcsController {
 public:
  /// The axis outlives the controller, which calls it "1" and lets it travel +-travel_mm.
  explicit GcsController(AxisModel& axis, double travel_mm = 2.0);

  /// Takes bytes off a line, which may be parts of commands, and returns what is answered to them.
  [[nodiscard]] std::string take(std::string_view bytes);
  /// Forgets half a command: the line was closed.
  void line_closed();

  // Faults.
  /// The axis stops with its servo off; ERR? tells the code once.
  void raise_alarm(int code);
  /// The next `count` moves are acknowledged and ignored.
  void refuse_moves(int count);
  /// The next `count` HLT, STP or #24 are refused with error 2 and not executed.
  void refuse_stops(int count);

  [[nodiscard]] int moves() const;  ///< moves to a target executed so far

 private:
  std::string execute(const std::string& line, HostTime now) FVD_REQUIRES(mutex_);
  std::string answer(const std::string& question, HostTime now) FVD_REQUIRES(mutex_);
  void move(double target_mm, HostTime now) FVD_REQUIRES(mutex_);
  void stop(HostTime now) FVD_REQUIRES(mutex_);
  [[nodiscard]] int set(const std::string& command, double value, HostTime now) FVD_REQUIRES(mutex_);

  AxisModel& axis_;
  const double travel_mm_;
  mutable Mutex mutex_;
  std::string input_ FVD_GUARDED_BY(mutex_);
  bool servo_ FVD_GUARDED_BY(mutex_) = false;
  int error_ FVD_GUARDED_BY(mutex_) = 0;
  double velocity_mm_per_s_ FVD_GUARDED_BY(mutex_) = 1.0;
  double acceleration_mm_per_s2_ FVD_GUARDED_BY(mutex_) = 20.0;
  double deceleration_mm_per_s2_ FVD_GUARDED_BY(mutex_) = 20.0;
  int refused_moves_ FVD_GUARDED_BY(mutex_) = 0;
  int refused_stops_ FVD_GUARDED_BY(mutex_) = 0;
  int moves_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd::sim
