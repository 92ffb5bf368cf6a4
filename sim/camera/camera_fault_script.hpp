#pragma once

/// Faults of the simulated camera in the order in which they are to happen.

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/mutex.hpp"

namespace fvd::sim {

/// The event at which a fault may strike.
enum class CameraEvent {
  kCommand,  ///< a command of the controller, heartbeats included
  kTrigger,  ///< a software trigger or an edge on the trigger line
  kFrame,    ///< the start of an exposure; the fault befalls its frame
};

enum class CameraFault {
  kDropLeader,      ///< the leader does not leave; the client may request it again
  kDropTrailer,     ///< the trailer, likewise
  kDropPacket,      ///< a packet in the middle of the image, likewise; with `value` 1 it cannot be requested again
  kDropFrame,       ///< no packet of the frame leaves, none can be asked for; its block id is used up
  kDropAck,         ///< executed, not acknowledged
  kIgnoreTrigger,   ///< acknowledged, nothing is exposed, no block id used
  kNackTrigger,     ///< refused: busy
  kDuplicateFrame,  ///< sent twice
  kReorderPackets,  ///< payload packets leave in reverse order, eight at a time
  kLateFrame,       ///< leaves `delay` late, all after it too
  kWrongSize,       ///< half as high as configured, and says so
  kTooLong,         ///< 64 bytes more than configured
  kEarlyLeader,     ///< the leader leaves when the exposure starts
  kIdJump,          ///< the block id grows by `value` more
  kIdsRestart,      ///< block ids start at the first again
  kStaleFrame,      ///< the pixels and the time of the frame before under a new id; the exposure is lost
  kDarkFrame,       ///< the light was off: black pixels
  kHalfFrame,       ///< black from the middle row downwards, delivered as complete
  kMute,            ///< the camera answers and sends nothing for `delay`
  kHang,            ///< the camera does nothing for `delay`, then continues where it was
  kRestart,         ///< as a power cycle: absent for `delay`, then without control, settings and ids
  kPendingAck,      ///< executed; a PENDING_ACK that promises `value` ms (0: `delay`), the acknowledge `delay` later
  kBusy,            ///< not executed, refused as busy
  kClockStep,       ///< the camera's clock, latch included, goes on `step` later
  kOddTime,         ///< the time of the frame is `step` off; the clock is not
  kChunkMode,       ///< chunk mode is on; with `value` 1 in the manner of GigE Vision 1.x, whose leader has no geometry
  kOtherFormat,     ///< the leader names another pixel format of the same size
  kPaddedLines,     ///< `value` bytes follow every line, and the leader says so
  kForgetStream,    ///< the destination of the stream is forgotten, control and settings are kept
};

/// The names of the faults in scripts: "drop_leader" and so on.
[[nodiscard]] const std::vector<std::string>& camera_fault_names();
[[nodiscard]] std::string_view name_of(CameraFault fault);
/// True for what befalls the camera as a whole, whatever it is doing.
[[nodiscard]] bool strikes_anywhere(CameraFault fault);
/// What the fault strikes at; what strikes anywhere strikes at a frame unless the step says otherwise.
[[nodiscard]] CameraEvent event_of(CameraFault fault);

struct CameraFaultStep {
  CameraFault fault = CameraFault::kDropFrame;
  std::optional<CameraEvent> on{};  ///< only for what strikes anywhere
  int after = 0;                    ///< number of matching events that pass first, >= 0
  int count = 1;                    ///< number of times that the fault happens, > 0
  std::chrono::milliseconds delay{0};
  int value = 0;                      ///< see kDropPacket, kIdJump, kPendingAck, kChunkMode, kPaddedLines
  std::chrono::milliseconds step{0};  ///< see kClockStep, kOddTime; may be negative
};

/// Steps are taken one after the other: a step waits until the one before it has happened as often as it should.
/// context: thread-safe.
class CameraFaultScript {
 public:
  /// Appends a step. Throws Error kBadConfig for one that cannot happen, naming it.
  void add(const CameraFaultStep& step);

  /// The fault that strikes at this event, if any. To be called once per event.
  [[nodiscard]] std::optional<CameraFaultStep> next(CameraEvent event);

  /// Steps that have not happened as often as they should.
  [[nodiscard]] std::size_t unconsumed() const;
  /// One line per step that has not happened; empty if all have.
  [[nodiscard]] std::string describe_unconsumed() const;

 private:
  mutable Mutex mutex_;
  std::deque<CameraFaultStep> steps_ FVD_GUARDED_BY(mutex_);  // after and count of the first run down
  int taken_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd::sim
