#pragma once

/// One trustworthy frame per height: triggers, waits, judges, retries.

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/hw/camera.hpp"
#include "core/scan/frame_ledger.hpp"

namespace fvd {

/// A frame that was exposed after the stage settled, and the number of triggers that it took.
struct CapturedFrame {
  Frame frame;
  int triggers = 1;
};

/// The next buffer is not assumed to be the answer to the trigger: a frame counts only if it is complete, newer than
/// every frame accepted before, and exposed after the stage settled. All others are booked and given back.
/// A frame is handed out once its exposure is over by the camera's clock too: whoever then asks for the stage's
/// position during it does not wait for that clock. context: the scan's thread.
class SliceCapture {
 public:
  /// camera, clock and ledger outlive the capture.
  SliceCapture(Camera& camera, Clock& clock, FrameLedger& ledger) : camera_(camera), clock_(clock), ledger_(ledger) {}

  /// The first acceptable frame exposed at or after `settled`, within 1 + retries triggers; nothing if all were lost.
  /// Throws Error kAborted after a stop request, kCameraDisconnected.
  [[nodiscard]] std::optional<CapturedFrame> capture(HostTime settled, int retries, std::stop_token stop);

  /// Error of a capture() that returned nothing: kCameraNoFrames if not even a part of a frame came for two triggers or
  /// more, else kCameraFramesLost, with the reason for which frames were refused. what: which frame, where.
  [[nodiscard]] Error failure(const std::string& what) const;

  /// Judges whether the stage stood where it should while a frame was exposed.
  using AtTarget = std::function<bool(const Frame& frame)>;

  /// The frame that the trigger line started in the move that has just ended: the first newer one that was exposed at
  /// the target; nothing if none came by the camera's deadline. Gaps in the ids are pulses whose frames were lost.
  /// Throws as capture().
  [[nodiscard]] std::optional<CapturedFrame> await_line(const AtTarget& at_target, std::stop_token stop);

 private:
  void drain();
  void wait_for_end(const Frame& frame, const std::stop_token& stop);
  [[nodiscard]] std::optional<Frame> trigger_once(HostTime settled, std::stop_token stop);

  Camera& camera_;
  Clock& clock_;
  FrameLedger& ledger_;
  std::optional<std::uint64_t> last_id_;
  int triggers_ = 0;    // of the last capture()
  bool heard_ = false;  // anything came for them
};

}  // namespace fvd
