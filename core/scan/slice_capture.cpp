#include "core/scan/slice_capture.hpp"

#include <utility>

#include "core/base/error.hpp"

namespace fvd {

namespace {

// Bound on the error of the camera-to-host clock map. The latch method is good to some 10 us; settling takes
// milliseconds, so this much slack cannot let a frame of the move before through.
constexpr std::chrono::microseconds kClockMapTolerance{200};

}  // namespace

void SliceCapture::drain() {
  while (camera_.next_frame(HostTime::min())) ledger_.stale();
}

std::optional<CapturedFrame> SliceCapture::capture(HostTime settled, int retries, std::stop_token stop) {
  drain();
  for (int triggers = 1; triggers <= 1 + retries; ++triggers) {
    if (stop.stop_requested()) break;
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
        ledger_.underrun();
      } else {
        ledger_.missing();
      }
      return std::nullopt;
    }
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
