#pragma once

/// One fault of the camera in the middle of a scan, and whether a wrong slice was accepted because of it.

#include <memory>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/scan/scan_runner.hpp"
#include "drivers/aravis/aravis_camera.hpp"
#include "sim/camera/gige_camera_server.hpp"
#include "sim/world/frame_watermark.hpp"
#include "sim/world/pattern_source.hpp"
#include "tests/support/timed_stage.hpp"

namespace fvd::test {

/// Counts slices and checks their watermarks: a slice is right if its pixels are intact, its exposure is new, and its z
/// is where it was exposed.
class CheckingSink final : public SliceSink {
 public:
  [[nodiscard]] bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
    const Slice taken = std::move(slice);
    const auto mark = sim::read_watermark(taken.frame.image);
    ++slices;
    if (!mark || std::abs(mark->z_um - taken.z_um) > tolerance_um || !exposures_.insert(mark->exposure_index).second) {
      ++wrong;
      what << "slice " << slices - 1 << " of z " << taken.z_um << " um, frame " << taken.frame.id;
      if (mark) what << ", was exposure " << mark->exposure_index << " at " << mark->z_um << " um";
      what << "; ";
    }
    return true;
  }

  double tolerance_um = 0.002;
  int slices = 0;
  int wrong = 0;
  std::ostringstream what;  ///< description of the wrong slices

 private:
  std::set<std::uint64_t> exposures_;
};

/// A camera whose frames identify their exposure, and a stage that arrives at once.
class MarkedCamera {
 public:
  explicit MarkedCamera(int width = 160, int height = 120, sim::GigeCameraOptions options = {})
      : pattern_(width, height), options_(std::move(options)) {
    options_.address = sim::free_camera_address();
    plug();
  }

  void plug() {
    server_.reset();
    server_ = std::make_unique<sim::GigeCameraServer>(source_, options_);
  }
  void unplug() { server_.reset(); }

  [[nodiscard]] CameraConfig config() const {
    CameraConfig config;
    config.address = options_.address;
    config.packet_socket = false;
    config.packet_size_bytes = 1500;
    return config;
  }
  [[nodiscard]] sim::GigeCameraServer& server() { return *server_; }
  [[nodiscard]] TimedStage& stage() { return stage_; }
  [[nodiscard]] const std::string& address() const { return options_.address; }

 private:
  TimedStage stage_;
  sim::PatternSource pattern_;
  sim::WatermarkedSource source_{pattern_, [this](HostTime at) { return stage_.z_um(at); }};
  sim::GigeCameraOptions options_;
  std::unique_ptr<sim::GigeCameraServer> server_;
};

struct CameraFaultCase {
  const char* name;
  sim::CameraFaultStep step;
  /// The error with which the scan must end; nothing = it completes.
  std::optional<ErrorCode> end{};
  int repeat = 1;  ///< the step stands in the script so often
};

/// For the names of the tests.
inline void PrintTo(const CameraFaultCase& of, std::ostream* out) { *out << of.name; }

/// Steps that strike at the fourth event.
namespace camera_fault_steps {

using sim::CameraFault;
using std::chrono::milliseconds;

inline sim::CameraFaultStep step(CameraFault fault, milliseconds delay = milliseconds(0), int value = 0,
                                 int count = 1) {
  return {.fault = fault, .after = 3, .count = count, .delay = delay, .value = value};
}
inline sim::CameraFaultStep at_command(CameraFault fault, milliseconds delay) {
  return {.fault = fault, .on = sim::CameraEvent::kCommand, .after = 3, .delay = delay};
}
inline sim::CameraFaultStep at_trigger(CameraFault fault, milliseconds delay) {
  return {.fault = fault, .on = sim::CameraEvent::kTrigger, .after = 3, .delay = delay};
}
/// Of time: off by so much.
inline sim::CameraFaultStep in_time(CameraFault fault, milliseconds off) {
  return {.fault = fault, .after = 3, .step = off};
}

}  // namespace camera_fault_steps

inline std::vector<CameraFaultCase> camera_fault_cases() {
  using namespace camera_fault_steps;
  using std::chrono::hours;
  using std::chrono::seconds;
  return {
      {"DropLeader", step(CameraFault::kDropLeader)},
      {"DropTrailer", step(CameraFault::kDropTrailer)},
      {"DropPacket", step(CameraFault::kDropPacket)},
      {"DropPacketForGood", step(CameraFault::kDropPacket, milliseconds(0), 1)},
      {"DropFrame", step(CameraFault::kDropFrame)},
      {"DropFrameThreeTimes", step(CameraFault::kDropFrame, milliseconds(0), 0, 3)},
      {"DropFrameTooOften", step(CameraFault::kDropFrame, milliseconds(0), 0, 5), ErrorCode::kCameraNoFrames},
      {"DropAck", step(CameraFault::kDropAck)},
      {"IgnoreTrigger", step(CameraFault::kIgnoreTrigger)},
      {"NackTrigger", step(CameraFault::kNackTrigger)},
      {"DuplicateFrame", step(CameraFault::kDuplicateFrame, milliseconds(0), 0, 3)},
      {"ReorderPackets", step(CameraFault::kReorderPackets, milliseconds(0), 0, 3)},
      {"LateFrameWithinTheDeadline", step(CameraFault::kLateFrame, milliseconds(150))},
      {"LateFrame", step(CameraFault::kLateFrame, milliseconds(400))},
      {"WrongSize", step(CameraFault::kWrongSize)},
      {"TooLong", step(CameraFault::kTooLong)},
      {"EarlyLeader", step(CameraFault::kEarlyLeader, milliseconds(0), 0, 4)},
      {"IdJump", step(CameraFault::kIdJump, milliseconds(0), 40)},
      {"IdJumpFar", step(CameraFault::kIdJump, milliseconds(0), 30000)},
      {"IdsRestart", step(CameraFault::kIdsRestart)},
      {"StaleFrame", step(CameraFault::kStaleFrame)},
      {"MuteForAWink", step(CameraFault::kMute, milliseconds(120))},
      {"MuteShorterThanAllowed", step(CameraFault::kMute, milliseconds(600))},
      {"MuteAtTriggerShorterThanAllowed", at_trigger(CameraFault::kMute, milliseconds(600))},
      {"MuteAtCommandShorterThanAllowed", at_command(CameraFault::kMute, milliseconds(600))},
      {"HangShorterThanAllowed", step(CameraFault::kHang, milliseconds(600))},
      {"BusyNowAndThen", step(CameraFault::kBusy), std::nullopt, 5},
      {"BusyTenTimes", step(CameraFault::kBusy, milliseconds(0), 0, 10)},
      {"PendingAck", step(CameraFault::kPendingAck, milliseconds(400), 800), std::nullopt, 2},
      {"PendingAckForLong", step(CameraFault::kPendingAck, milliseconds(1500), 3000)},
      {"OddTimeAhead", in_time(CameraFault::kOddTime, hours(1))},
      {"OddTimeBack", in_time(CameraFault::kOddTime, -hours(1))},
      {"OddTimeAheadEveryFourthFrame", in_time(CameraFault::kOddTime, hours(1)), std::nullopt, 3},
      {"OddTimeBackEveryFourthFrame", in_time(CameraFault::kOddTime, -hours(1)), std::nullopt, 3},
      {"ClockStepAheadASecond", in_time(CameraFault::kClockStep, seconds(1))},
      {"ClockStepBackASecond", in_time(CameraFault::kClockStep, -seconds(1))},
      {"ClockStepAhead", in_time(CameraFault::kClockStep, hours(1))},
      {"ClockStepBack", in_time(CameraFault::kClockStep, -hours(1))},
      {"OtherFormat", step(CameraFault::kOtherFormat)},
      {"OtherFormatTooOften", step(CameraFault::kOtherFormat, milliseconds(0), 0, 4), ErrorCode::kCameraFramesLost},
      {"ChunkMode", step(CameraFault::kChunkMode)},
      {"ChunkModeOfOldCameras", step(CameraFault::kChunkMode, milliseconds(0), 1)},
      {"PaddedLines", step(CameraFault::kPaddedLines, milliseconds(0), 8, 5)},
      {"ForgetStream", step(CameraFault::kForgetStream), ErrorCode::kCameraNoFrames},
      {"Mute", step(CameraFault::kMute, milliseconds(3000)), ErrorCode::kCameraDisconnected},
      {"HangInExposure", step(CameraFault::kHang, milliseconds(1500)), ErrorCode::kCameraDisconnected},
      {"HangAtTrigger", at_trigger(CameraFault::kHang, milliseconds(1500)), ErrorCode::kCameraDisconnected},
      {"HangAtCommand", at_command(CameraFault::kHang, milliseconds(1500)), ErrorCode::kCameraDisconnected},
      {"Restart", step(CameraFault::kRestart, milliseconds(300)), ErrorCode::kCameraDisconnected},
      {"RestartAtTrigger", at_trigger(CameraFault::kRestart, milliseconds(300)), ErrorCode::kCameraDisconnected},
  };
}

struct CameraFaultOutcome {
  int slices = 0;
  int wrong = 0;                   ///< accepted slices whose pixels or z are wrong
  int unbalanced = 0;              ///< scans whose books do not balance
  std::optional<ErrorCode> end{};  ///< error of the scan that the fault strikes
  double end_ms = 0.0;             ///< from the camera's last frame to that end, where the connection was lost
  double recover_ms = 0.0;         ///< from the camera's return to the first slice of the next scan
  std::size_t unconsumed = 0;
  std::string story;
};

inline constexpr int kCameraFaultSlices = 12;

inline ScanPlan camera_fault_plan() {
  ScanPlan plan;
  plan.step = Micrometers{10.0};
  plan.slices = kCameraFaultSlices;
  return plan;
}

inline CameraSettings camera_fault_settings() {
  CameraSettings settings;
  settings.exposure_us = 2000.0;
  return settings;
}

/// Opens the camera as the machine's thread does: one attempt every 0.2 s, for 10 s at most.
inline std::unique_ptr<Camera> open_again(const CameraConfig& config) {
  const HostTime deadline = HostClock::now() + std::chrono::seconds(10);
  SystemClock clock;
  for (;;) {
    try {
      return open_aravis_camera(config);
    } catch (const Error&) {
      if (HostClock::now() > deadline) throw;
    }
    clock.wait_until(HostClock::now() + std::chrono::milliseconds(200), {});
  }
}

/// A scan with the fault in it, then one without on the same connection, or on a new one if that was lost.
inline CameraFaultOutcome run_camera_fault_case(const CameraFaultCase& fault) {
  sim::GigeCameraOptions options;
  const bool longer =
      fault.step.fault == sim::CameraFault::kChunkMode || fault.step.fault == sim::CameraFault::kPaddedLines;
  if (longer) options.payload_margin_bytes = 4096;
  MarkedCamera marked(160, 120, options);
  CameraFaultOutcome outcome;
  std::ostringstream story;
  auto camera = open_aravis_camera(marked.config());
  camera->configure(camera_fault_settings());
  SystemClock clock;
  for (int i = 0; i < fault.repeat; ++i) marked.server().faults().add(fault.step);
  std::jthread reaper;
  HostTime struck{};
  for (int round = 0; round < 2; ++round) {
    CheckingSink sink;
    ScanReport report;
    const HostTime began = HostClock::now();
    HostTime last_slice = began;
    try {
      camera->configure(camera_fault_settings());
      ScanRunner({*camera, marked.stage(), clock, sink})
          .run(camera_fault_plan(), report, [&](const ScanReport&) { last_slice = HostClock::now(); }, {});
    } catch (const Error& error) {
      story << "scan " << round << " ends: " << error.what() << "; ";
      if (round == 0) outcome.end = error.code();
      if (round == 1) ++outcome.unbalanced;  // the camera is well again
    }
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(HostClock::now() - began).count();
    story << "scan " << round << " took " << ms << " ms: ";
    outcome.slices += sink.slices;
    outcome.wrong += sink.wrong;
    if (!report.frames.balanced() || report.frames.ok != static_cast<std::uint64_t>(sink.slices)) ++outcome.unbalanced;
    story << sink.slices << " slices, expected " << report.frames.expected << " ok " << report.frames.ok
          << " incomplete " << report.frames.incomplete << " missing " << report.frames.missing << " stale "
          << report.frames.stale << " underrun " << report.frames.underrun << "; " << sink.what.str();
    if (round == 1) break;
    struck = last_slice;
    if (outcome.end == ErrorCode::kCameraDisconnected || outcome.end == ErrorCode::kCameraNoFrames) {
      outcome.end_ms = std::chrono::duration<double, std::milli>(HostClock::now() - struck).count();
      // Closing it takes as long as the camera is silent, and it keeps control for so long.
      reaper = std::jthread([dead = std::move(camera)]() mutable { dead.reset(); });
      camera = open_again(marked.config());
      const HostTime back = std::max(struck + fault.step.delay, struck);
      camera->configure(camera_fault_settings());
      camera->trigger();
      const auto frame = camera->next_frame(HostClock::now() + std::chrono::seconds(2));
      if (!frame || frame->status != FrameStatus::kOk) ++outcome.unbalanced;
      outcome.recover_ms = std::chrono::duration<double, std::milli>(HostClock::now() - back).count();
    }
  }
  outcome.unconsumed = marked.server().faults().unconsumed();
  outcome.story = story.str();
  return outcome;
}

}  // namespace fvd::test
