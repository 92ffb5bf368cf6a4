#pragma once

/// Doubles for continuous scans: an axis on its way and a camera that runs free, on a clock that passes only when the
/// camera is asked for a frame.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/scan/continuous_scan.hpp"
#include "gtest/gtest.h"

namespace fvd::test {

using std::chrono::duration_cast;
using std::chrono::microseconds;

/// context: thread-safe.
class TestClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override { return now_; }
  void wait_until(HostTime deadline, std::stop_token /*stop*/) override { advance_to(deadline); }
  void advance_to(HostTime time) {
    {
      const std::lock_guard lock(mutex_);
      if (time > now_.load()) now_ = time;
    }
    changed_.notify_all();
  }
  /// Blocks until somebody else has let so much time pass; false on a stop request.
  bool await(HostTime time, std::stop_token stop) {
    std::unique_lock lock(mutex_);
    return changed_.wait(lock, stop, [&] { return now_.load() >= time; });
  }

 private:
  std::atomic<HostTime> now_{HostTime{std::chrono::hours(1)}};
  std::mutex mutex_;
  std::condition_variable_any changed_;
};

/// Trapezoidal motion with 20000 um/s^2.
class SweepingStage final : public Axis {
 public:
  explicit SweepingStage(TestClock& clock) : clock_(clock) {}

  [[nodiscard]] StageInfo info() const override {
    return {.name = "sweeping stage",
            .address = "in process",
            .feedback = feedback,
            .step_quantum = Micrometers{0.01},
            .feedback_resolution = Micrometers{0.01},
            .min = Micrometers{-500.0},
            .max = Micrometers{500.0},
            .take_up = Micrometers{20.0},
            .speed_um_per_s = 1000.0,
            .acceleration_um_per_s2 = 20000.0,
            .simulated = true};
  }
  [[nodiscard]] StageStatus status() override {
    StageStatus status;
    status.homed = true;
    return status;
  }
  void home(std::stop_token /*stop*/) override {}
  MoveRecord move_to(Micrometers target, const SettleCriterion& /*criterion*/, std::stop_token /*stop*/) override {
    from_um = to_um = target.value;
    return {};
  }
  MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) override {
    HostTime end;
    {
      const std::lock_guard lock(mutex_);
      from_um = to_um;
      to_um = target.value;
      speed = speed_um_per_s;
      started = clock_.now();
      const double seconds = std::abs(to_um - from_um) / speed + speed / 20000.0;
      end = started + duration_cast<HostClock::duration>(std::chrono::duration<double>(alarm ? 0.1 : seconds));
    }
    if (!clock_.await(end, stop)) throw Error(ErrorCode::kAborted, "the sweep was stopped");
    if (alarm) throw Error(ErrorCode::kStageAlarm, "the drive reports an alarm");
    return {};
  }
  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override {
    return {Micrometers{true_um(from + (to - from) / 2)}, Micrometers{0.0}, 3};
  }
  /// What the samples say: late by `lag`.
  [[nodiscard]] PositionMean position_at(HostTime at, microseconds /*reach*/) override {
    return {Micrometers{true_um(at - lag)}, Micrometers{0.0}, 9};
  }
  void stop() noexcept override { ++stops; }
  [[nodiscard]] bool connected() const noexcept override { return true; }

  [[nodiscard]] double true_um(HostTime at) const {
    const std::lock_guard lock(mutex_);
    if (speed <= 0.0) return to_um;
    const double ramp_s = speed / 20000.0;
    const double way = std::abs(to_um - from_um);
    const double total_s = way / speed + ramp_s;
    const double t = std::clamp(std::chrono::duration<double>(at - started).count(), 0.0, total_s);
    double done = way;
    if (t < ramp_s) {
      done = 0.5 * 20000.0 * t * t;
    } else if (t < total_s - ramp_s) {
      done = speed * (t - ramp_s / 2);
    } else {
      const double left = total_s - t;
      done = way - 0.5 * 20000.0 * left * left;
    }
    return from_um + (to_um > from_um ? done : -done);
  }

  FeedbackSource feedback = FeedbackSource::kMotorEncoder;
  bool alarm = false;
  microseconds lag{0};
  std::atomic<int> stops{0};
  double from_um = 0.0;
  double to_um = 0.0;
  double speed = 0.0;
  HostTime started{};

 private:
  TestClock& clock_;
  mutable std::mutex mutex_;
};

enum class Fate { kGood, kNothing, kUnderrun, kIncomplete, kNotExposed, kGone };

/// Free-running; the fate of a frame is told by the position it is exposed at. Pixels: none, only times and ids count.
class FreeCamera final : public Camera, private FrameRecycler {
 public:
  FreeCamera(TestClock& clock, const SweepingStage& stage) : clock_(clock), stage_(stage) {}

  [[nodiscard]] CameraInfo info() const override { return {}; }
  CameraSettings configure(const CameraSettings& settings) override {
    settings_ = settings;
    next_ = clock_.now();
    return settings;
  }
  void trigger() override { ADD_FAILURE() << "nobody triggers a camera that runs free"; }
  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    if (settings_.trigger != TriggerMode::kFreeRun) {
      clock_.advance_to(deadline);
      return std::nullopt;
    }
    const auto period = duration_cast<HostClock::duration>(
        std::chrono::duration<double>(1.0 / (settings_.frame_rate_hz * rate_factor)));
    for (;;) {
      const HostTime arrival = next_ + std::chrono::milliseconds(5);
      if (arrival > deadline) {
        clock_.advance_to(deadline);
        return std::nullopt;
      }
      const HostTime start = next_;
      next_ += period;
      const Fate fate = fate_of(stage_.true_um(start + exposure() / 2));
      if (fate == Fate::kNotExposed) continue;  // the camera counts on without a gap
      const std::uint64_t id = ++id_;
      if (fate == Fate::kGone) throw Error(ErrorCode::kCameraDisconnected, "the camera was unplugged");
      clock_.advance_to(arrival);
      if (fate == Fate::kUnderrun) ++health_.underruns;
      if (fate == Fate::kNothing || fate == Fate::kUnderrun) continue;
      Frame frame;
      frame.lease = FrameLease(&slot_, FrameSlotDeleter{this});
      if (fate == Fate::kIncomplete) return frame;
      frame.status = FrameStatus::kOk;
      frame.id = id;
      frame.exposure_start = start;
      frame.exposure_end = start + exposure();
      return frame;
    }
  }
  [[nodiscard]] microseconds frame_deadline() const override { return std::chrono::milliseconds(100); }
  void interrupt() noexcept override {}
  [[nodiscard]] bool connected() const noexcept override { return true; }
  [[nodiscard]] CameraHealth health() const override { return health_; }
  [[nodiscard]] TriggerMode trigger_mode() const { return settings_.trigger; }

  /// Frames exposed within so many um of a position have that fate.
  void plan(double from_um, double to_um, Fate fate) { fates_.push_back({from_um, to_um, fate}); }

  double rate_factor = 1.0;  ///< frames taken over frames asked for

 private:
  struct Planned {
    double from_um;
    double to_um;
    Fate fate;
  };
  [[nodiscard]] HostClock::duration exposure() const {
    return duration_cast<HostClock::duration>(std::chrono::duration<double, std::micro>(settings_.exposure_us));
  }
  [[nodiscard]] Fate fate_of(double z_um) const {
    for (const Planned& planned : fates_) {
      if (z_um >= planned.from_um && z_um < planned.to_um) return planned.fate;
    }
    return Fate::kGood;
  }
  void recycle(void* /*slot*/) noexcept override {}

  TestClock& clock_;
  const SweepingStage& stage_;
  CameraSettings settings_;
  HostTime next_{};
  std::uint64_t id_ = 0;
  CameraHealth health_;
  std::vector<Planned> fates_;
  int slot_ = 0;
};

class HeightSink final : public SliceSink {
 public:
  [[nodiscard]] bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
    const Slice taken = std::move(slice);
    z_um.push_back(taken.z_um);
    starts.push_back(taken.frame.exposure_start);
    return true;
  }
  std::vector<double> z_um;
  std::vector<HostTime> starts;
};

}  // namespace fvd::test
