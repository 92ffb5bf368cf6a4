#pragma once

/// Sensor and stream channel of the simulated camera: exposes on triggers or on its own, reads out and sends while the
/// next exposure runs.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "sim/camera/camera_fault_script.hpp"
#include "sim/camera/camera_registers.hpp"
#include "sim/camera/gvsp_sender.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::sim {

/// A time until which the camera does nothing. context: thread-safe.
class Standstill {
 public:
  void until(HostTime time) { time_ = time; }
  [[nodiscard]] HostTime end() const { return time_; }
  [[nodiscard]] bool now() const { return HostClock::now() < time_.load(); }

 private:
  std::atomic<HostTime> time_{HostTime{}};
};

/// context: thread-safe. Exposes on one thread, renders and sends on another.
class GigeStreamer {
 public:
  /// Called with a fault step that strikes anywhere, which the camera server carries out.
  using Struck = std::function<void(const CameraFaultStep&)>;

  /// All references outlive the streamer. mute: no packet leaves until its end; hung: the sensor does nothing until its
  /// end. Throws Error kBadConfig if there is no socket for the stream.
  GigeStreamer(FrameSource& source, CameraRegisters& registers, CameraFaultScript& faults, const Standstill& mute,
               const Standstill& hung, GvspSender& sender, std::uint64_t first_block_id, bool extended_ids,
               Struck struck);
  ~GigeStreamer();

  /// AcquisitionStart: block ids start over; AcquisitionStop: a frame under way is abandoned. In AcquisitionMode
  /// SingleFrame the acquisition ends by itself.
  void set_acquiring(bool on);
  /// Starts an exposure; ignored if one runs or the camera does not wait for a trigger of this kind. False only if a
  /// fault of the script refuses it as busy.
  bool trigger(bool by_line);
  /// To be called after registers have changed.
  void look_again();

  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  [[nodiscard]] std::uint64_t frames_dropped() const noexcept { return dropped_; }
  /// Camera time of a moment.
  [[nodiscard]] std::uint64_t timestamp_ns(HostTime time) const;
  /// The camera's clock goes on so much later, or earlier.
  void step_clock(std::chrono::milliseconds step) { clock_ahead_ns_ += std::chrono::nanoseconds(step).count(); }

 private:
  /// An exposure that is over, or that was lost to its fault.
  struct Exposure {
    CameraState state;
    ExposureRequest request;
    std::uint64_t block_id = 0;
    std::uint64_t timestamp_ns = 0;
    std::uint64_t acquisition = 0;
    std::optional<CameraFaultStep> fault;
  };

  void expose(std::stop_token stop);
  bool expose_one(const CameraState& state, HostTime start, std::uint64_t acquisition, std::stop_token stop);
  void read_out(std::stop_token stop);
  void send(const Exposure& exposure, std::stop_token stop);
  std::shared_ptr<StreamFrame> develop(const Exposure& exposure);
  StreamFrame header_of(const Exposure& exposure) const;
  bool wait_until(HostTime time, std::uint64_t acquisition, std::stop_token stop);
  void stand_still(std::stop_token stop);

  FrameSource& source_;
  CameraRegisters& registers_;
  CameraFaultScript& faults_;
  const Standstill& mute_;
  const Standstill& hung_;
  GvspSender& sender_;
  const std::uint64_t first_block_id_;
  const bool extended_ids_;
  const Struck struck_;
  const HostTime started_ = HostClock::now();
  // A camera that has run for a day: its clock can be stepped back without passing zero.
  std::atomic<std::int64_t> clock_ahead_ns_{86'400'000'000'000};

  Mutex mutex_;
  Condition changed_;
  bool acquiring_ FVD_GUARDED_BY(mutex_) = false;
  bool triggered_ FVD_GUARDED_BY(mutex_) = false;
  bool exposing_ FVD_GUARDED_BY(mutex_) = false;
  // Counts starts and stops: tells a frame that it is out of date.
  std::uint64_t acquisition_ FVD_GUARDED_BY(mutex_) = 0;
  std::uint64_t next_block_id_ FVD_GUARDED_BY(mutex_) = 1;
  std::deque<Exposure> exposed_ FVD_GUARDED_BY(mutex_);

  std::uint64_t exposures_ = 0;                // exposing thread only
  std::shared_ptr<const StreamFrame> before_;  // reading thread only
  std::vector<std::byte> image_;               // likewise
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> dropped_{0};

  std::jthread reading_;  // the threads last
  std::jthread exposing_thread_;
};

}  // namespace fvd::sim
