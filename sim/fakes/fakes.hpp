#pragma once

/// In-process doubles of the hardware interfaces for fast, deterministic tests of the scan. Time passes only while
/// something waits.

#include <atomic>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/clock.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "core/scan/slice_sink.hpp"

namespace fvd::sim {

/// context: one thread.
class FakeClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override { return now_; }
  void wait_until(HostTime deadline, std::stop_token stop) override;
  void advance_to(HostTime time);

 private:
  HostTime now_{std::chrono::hours(1)};
};

/// The outcome of one trigger.
enum class TriggerOutcome {
  kFrame,          ///< a good frame
  kNothing,        ///< no frame, and no sign of one
  kIncomplete,     ///< a damaged frame
  kWrongGeometry,  ///< a complete frame of another size
  kLate,           ///< a good frame that arrives after the deadline
  kTwice,          ///< the frame and a repetition of it
  kUnderrun,       ///< no frame, because no buffer was free
  kTooEarly,       ///< a frame that was exposed before the trigger, left over in the camera
  kDisconnect,     ///< the connection is lost
};

/// A camera that follows a script, one entry per trigger, then delivers good frames. Every pixel of a frame holds the
/// number of the trigger that made it, modulo 256. Aborts the program if it is destroyed before the script has ended.
/// context: one thread, except interrupt().
class FakeCamera : public Camera, private FrameRecycler {
 public:
  FakeCamera(FakeClock& clock, int width, int height, std::deque<TriggerOutcome> script = {});
  ~FakeCamera() override;

  [[nodiscard]] CameraInfo info() const override;
  CameraSettings configure(const CameraSettings& settings) override;
  void trigger() override;
  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override;
  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return std::chrono::milliseconds(100); }
  void interrupt() noexcept override { interrupted_ = true; }
  [[nodiscard]] bool connected() const noexcept override { return connected_; }
  [[nodiscard]] CameraHealth health() const override { return health_; }

  [[nodiscard]] int triggers() const { return triggers_; }

  /// Draws the frame of a trigger, 1-based modulo 256, if set; pixels: [height][width].
  std::function<void(int trigger, std::span<std::byte> pixels)> paint;
  std::chrono::microseconds clock_error{0};  ///< added to the exposure times of frames
  [[nodiscard]] int frames_lent() const { return lent_; }

 private:
  struct Pending {
    HostTime arrival;
    FrameStatus status;
    std::uint64_t id;
    HostTime exposure_start;
    std::uint8_t content;
  };
  void recycle(void* slot) noexcept override;
  void arrive(std::chrono::milliseconds after, FrameStatus status, std::uint64_t id, HostTime exposure_start);
  [[nodiscard]] Frame lend(const Pending& pending);

  FakeClock& clock_;
  int width_;
  int height_;
  std::deque<TriggerOutcome> script_;
  std::deque<Pending> pending_;
  CameraHealth health_;
  std::uint64_t next_id_ = 1;
  int triggers_ = 0;
  std::atomic<int> lent_{0};  // taken on the scan's thread, given back on any
  bool connected_ = true;
  std::atomic<bool> interrupted_{false};
};

/// An axis that arrives in 50 ms and rests exactly `error_um` beside its target. context: one thread.
class FakeAxis : public Axis {
 public:
  explicit FakeAxis(FakeClock& clock) : clock_(clock) {}

  [[nodiscard]] StageInfo info() const override { return description; }
  [[nodiscard]] StageStatus status() override;
  void home(std::stop_token stop) override;
  MoveRecord move_to(Micrometers target, const SettleCriterion& criterion, std::stop_token stop) override;
  MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) override;
  [[nodiscard]] PositionMean mean_position(HostTime from, HostTime to) override;
  [[nodiscard]] PositionMean position_at(HostTime at, std::chrono::microseconds reach) override;
  void stop() noexcept override { ++stops; }
  [[nodiscard]] bool connected() const noexcept override { return true; }

  StageInfo description{.name = "fake axis",
                        .address = "in process",
                        .feedback = FeedbackSource::kMotorEncoder,
                        .step_quantum = Micrometers{0.01},
                        .feedback_resolution = Micrometers{0.01},
                        .min = Micrometers{-500.0},
                        .max = Micrometers{500.0},
                        .take_up = Micrometers{20.0},
                        .simulated = true};
  bool is_homed = true;
  double error_um = 0.0;
  int stops = 0;
  HostTime settled{};       ///< time at which the last move had settled
  bool mean_moved = false;  ///< true once mean_position() was called for a time before the last move had settled
  std::vector<double> targets_um;
  std::optional<double> fail_at_um;  ///< kStagePosition at this target
  std::function<void()> on_move;

 private:
  FakeClock& clock_;
  double position_um_ = 0.0;
};

/// Records z and content of each slice; refuses the slice of index refuse_at. context: one thread.
class SpySink final : public SliceSink {
 public:
  [[nodiscard]] bool push(Slice&& slice, HostTime deadline, std::stop_token stop) override;

  int refuse_at = -1;
  std::vector<double> z_um;
  std::vector<int> contents;
};

}  // namespace fvd::sim
