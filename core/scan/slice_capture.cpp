#include "core/scan/slice_capture.hpp"

#include <utility>

namespace fvd {

namespace {

// Bound on the error of the camera-to-host clock map. The latch method is good to some 10 us; settling takes
// milliseconds, so this much slack cannot let a frame of the move before through.
constexpr std::chrono::microseconds kClockMapTolerance{200};

}  // namespace

void SliceCapture::drain() {
  while (camera_.next_frame(HostTime::min())) ledger_.stale();
}

/// A camera may date a frame by the end of its exposure, so that this lies in the future, by one exposure at most.
void SliceCapture::wait_for_end(const Frame& frame, const std::stop_token& stop) {
  if (frame.exposure_end > clock_.now()) clock_.wait_until(frame.exposure_end, stop);
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped while it waited for a frame");
}

Error SliceCapture::failure(const std::string& what) const {
  const std::string triggers = " within " + std::to_string(triggers_) + " triggers";
  if (!heard_ && triggers_ > 1) {
    return {ErrorCode::kCameraNoFrames,
            what + triggers +
                ": the camera answers, but not even a part of a frame came; it is being opened anew. If that does not "
                "help, look at the firewall, at the camera's trigger source and at who else receives its stream"};
  }
  const std::string refusal = camera_.last_refusal();
  return {ErrorCode::kCameraFramesLost,
          what + triggers +
              (refusal.empty() ? ": check the camera's link and its packet counters" : "; refused: " + refusal)};
}

std::optional<CapturedFrame> SliceCapture::capture(HostTime settled, int retries, std::stop_token stop) {
  drain();
  triggers_ = 0;
  heard_ = false;
  for (int triggers = 1; triggers <= 1 + retries; ++triggers) {
    if (stop.stop_requested()) break;
    triggers_ = triggers;
    if (auto frame = trigger_once(settled, stop)) return CapturedFrame{std::move(*frame), triggers};
  }
  if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped while it waited for a frame");
  return std::nullopt;
}

std::optional<Frame> SliceCapture::trigger_once(HostTime settled, std::stop_token stop) {
  const auto underruns_before = camera_.health().underruns;
  camera_.trigger();
  const HostTime deadline = clock_.now() + camera_.frame_deadline();
  for (;;) {
    std::optional<Frame> frame;
    try {
      frame = camera_.next_frame(deadline);
    } catch (...) {
      ledger_.missing();
      throw;
    }
    if (!frame) {
      if (camera_.health().underruns > underruns_before && !stop.stop_requested()) {
        heard_ = true;  // it came, and found no room
        ledger_.underrun();
      } else {
        ledger_.missing();
      }
      return std::nullopt;
    }
    heard_ = true;
    if (frame->status != FrameStatus::kOk) {
      if (ledger_.explain_missing_by_incomplete()) continue;
      ledger_.incomplete();
      return std::nullopt;
    }
    const bool newer = !last_id_ || frame->id > *last_id_;
    if (!newer || frame->exposure_start < settled - kClockMapTolerance) {
      ledger_.stale();
      continue;
    }
    last_id_ = frame->id;
    ledger_.ok();
    wait_for_end(*frame, stop);
    return frame;
  }
}

std::optional<CapturedFrame> SliceCapture::await_line(const AtTarget& at_target, std::stop_token stop) {
  const HostTime deadline = clock_.now() + camera_.frame_deadline();
  for (;;) {
    auto frame = camera_.next_frame(deadline);
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "the scan was stopped while it waited for a frame");
    if (!frame) {
      ledger_.missing();
      return std::nullopt;
    }
    if (frame->status != FrameStatus::kOk) {
      ledger_.incomplete();
      return std::nullopt;
    }
    wait_for_end(*frame, stop);
    const bool newer = !last_id_ || frame->id > *last_id_;
    if (!newer || !at_target(*frame)) {
      ledger_.stale();
      continue;
    }
    last_id_ = frame->id;
    ledger_.ok();
    return CapturedFrame{std::move(*frame), 1};
  }
}

}  // namespace fvd
