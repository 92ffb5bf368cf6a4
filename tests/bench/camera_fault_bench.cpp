/// Faults, loss, restarts and the wrap of block ids on simulated cameras.

#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>

#include "drivers/aravis/camera_search.hpp"
#include "tests/bench/camera_benches.hpp"
#include "tests/support/camera_fault_case.hpp"
#include "tests/support/marked_plan.hpp"

namespace fvd::test {

namespace {

using std::chrono::seconds;

double milliseconds_since(HostTime begin) {
  return std::chrono::duration<double, std::milli>(HostClock::now() - begin).count();
}

}  // namespace

FaultFigures run_faults() {
  FaultFigures figures;
  for (const CameraFaultCase& fault : camera_fault_cases()) {
    const CameraFaultOutcome outcome = run_camera_fault_case(fault);
    ++figures.cases;
    const bool otherwise = outcome.end != fault.end || outcome.unconsumed > 0;
    figures.as_expected += otherwise ? 0 : 1;
    figures.wrong += outcome.wrong;
    figures.violations += outcome.unbalanced;
    const std::string name = fault.name;
    if (name.starts_with("Hang")) figures.hang_ms = std::max(figures.hang_ms, outcome.end_ms);
    if (name.starts_with("Restart")) figures.recover_ms = std::max(figures.recover_ms, outcome.recover_ms);
    std::printf("fault: %-28s %2d slices, %d wrong, end %s, noticed after %.0f ms, back after %.0f ms\n", fault.name,
                outcome.slices, outcome.wrong,
                outcome.end ? std::string(error_name(*outcome.end)).c_str() : "completed", outcome.end_ms,
                outcome.recover_ms);
    if (otherwise) std::printf("  OTHERWISE: %s\n", outcome.story.c_str());
  }
  return figures;
}

int camera_found_by() {
  sim::GigeCameraOptions options;
  options.serial = "S-4711";
  options.name = "left";
  MarkedCamera marked(64, 48, options);
  CameraConfig config = marked.config();
  config.search_address = marked.address();
  const auto known = identify_camera(marked.address(), seconds(5));
  int found = 0;
  for (const std::string& name : {marked.address(), std::string("S-4711"), known ? known->mac : std::string("no MAC"),
                                  std::string("left"), std::string("fvd-SimulatedCamera-S-4711")}) {
    config.address = name;
    try {
      found += open_aravis_camera(config)->info().serial == "S-4711" ? 1 : 0;
    } catch (const Error& error) {
      std::printf("by '%s': %s\n", name.c_str(), error.what());
    }
  }
  return found;
}

int wrong_camera_used() {
  MarkedCamera marked(64, 48);
  CameraConfig config = marked.config();
  config.search_address = marked.address();
  int used = 0;
  for (const std::string& name : {marked.address(), std::string("SIM01"), std::string("fvd-SimulatedCamera-SIM01")}) {
    config.address = name;
    config.serial = "SIM02";
    try {
      (void)open_aravis_camera(config);
      ++used;
    } catch (const Error& error) {
      std::printf("refused: %s\n", error.what());
    }
  }
  return used;
}

double recover_after_kill() {
  MarkedCamera marked;
  auto camera = open_aravis_camera(marked.config());
  camera->configure(camera_fault_settings());
  marked.unplug();
  try {
    for (;;) {
      camera->trigger();
      (void)camera->next_frame(HostClock::now() + seconds(2));
    }
  } catch (const Error&) {
  }
  std::jthread reaper([dead = std::move(camera)]() mutable { dead.reset(); });
  marked.plug();
  const HostTime back = HostClock::now();
  camera = open_again(marked.config());
  camera->configure(camera_fault_settings());
  camera->trigger();
  if (!camera->next_frame(HostClock::now() + seconds(2))) return 1e9;
  return milliseconds_since(back);
}

int right_slices(double packet_loss, int scans, int slices) {
  MarkedCamera marked(320, 240);
  auto camera = open_aravis_camera(marked.config());
  camera->configure(camera_fault_settings());
  marked.server().set_packet_loss(packet_loss);
  SystemClock clock;
  int right = 0;
  for (int i = 0; i < scans; ++i) {
    CheckingSink sink;
    ScanReport report;
    camera->configure(camera_fault_settings());
    try {
      ScanRunner({*camera, marked.stage(), clock, sink}).run(marked_plan(slices), report, {}, {});
    } catch (const Error& error) {
      std::printf("scan of %d slices: %s\n", slices, error.what());
    }
    right += sink.slices - sink.wrong;
  }
  return right;
}

int lost_over_the_wrap(int frames) {
  MarkedCamera marked(64, 48, {.first_block_id = 60000});
  auto camera = open_aravis_camera(marked.config());
  CameraSettings settings;
  settings.exposure_us = 50.0;
  camera->configure(settings);
  int lost = 0;
  int wrong = 0;
  std::uint64_t last_id = 0;
  std::uint64_t last_exposure = 0;
  for (int i = 0; i < frames; ++i) {
    camera->trigger();
    const auto frame = camera->next_frame(HostClock::now() + camera->frame_deadline());
    const auto mark = frame && frame->status == FrameStatus::kOk ? sim::read_watermark(frame->image) : std::nullopt;
    if (!mark) {
      ++lost;
      continue;
    }
    if (i > 0 && (frame->id - last_id != mark->exposure_index - last_exposure || frame->id <= last_id)) ++wrong;
    last_id = frame->id;
    last_exposure = mark->exposure_index;
  }
  std::printf("wrap: %d frames, %d lost, %d wrong, %llu ids skipped\n", frames, lost, wrong,
              static_cast<unsigned long long>(camera->health().ids_skipped));
  return lost + wrong;
}

}  // namespace fvd::test
