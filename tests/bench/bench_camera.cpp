/// What the camera driver does on a simulated camera: faults, loss, restarts, the wrap of block ids, throughput, slices
/// a second, and a scan in one motion against the same slices step by step. Prints a table; the last line is one JSON
/// object. With the argument "soak" it lets a camera run free at 2048 x 2048 over a gigabit line for ten minutes
/// instead.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "config/strict_json.hpp"
#include "core/focus/streaming_focus_stack.hpp"
#include "core/scan/continuous_scan.hpp"
#include "core/scan/focus_worker.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "drivers/registry/driver_table.hpp"
#include "sim/camera/gvsp_sender.hpp"
#include "sim/evaluate/evaluate.hpp"
#include "sim/plant/plant.hpp"
#include "tests/support/camera_fault_case.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;

double seconds_of(HostClock::duration time) { return std::chrono::duration<double>(time).count(); }

/// CPU time of the threads whose name begins so, in s.
double cpu_seconds(const std::string& name) {
  double ticks = 0.0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm") >> std::ws, comm);
    if (comm.compare(0, name.size(), name) != 0) continue;
    std::string stat;
    std::getline(std::ifstream(task.path() / "stat"), stat);
    std::istringstream fields(stat.substr(stat.rfind(')') + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0.0;
    double system = 0.0;
    fields >> user >> system;
    ticks += user + system;
  }
  return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// --- faults ---

struct FaultFigures {
  int cases = 0;
  int wrong = 0;
  int violations = 0;
  double hang_ms = 0.0;
  double recover_ms = 0.0;
};

FaultFigures run_faults() {
  FaultFigures figures;
  for (const CameraFaultCase& fault : camera_fault_cases()) {
    const CameraFaultOutcome outcome = run_camera_fault_case(fault);
    ++figures.cases;
    figures.wrong += outcome.wrong;
    figures.violations += outcome.unbalanced;
    const std::string name = fault.name;
    if (name.starts_with("Hang")) figures.hang_ms = std::max(figures.hang_ms, outcome.end_ms);
    if (name.starts_with("Restart")) figures.recover_ms = std::max(figures.recover_ms, outcome.recover_ms);
    std::printf("fault: %-28s %2d slices, %d wrong, end %s, noticed after %.0f ms, back after %.0f ms\n", fault.name,
                outcome.slices, outcome.wrong,
                outcome.end ? std::string(error_name(*outcome.end)).c_str() : "completed", outcome.end_ms,
                outcome.recover_ms);
    if (outcome.end != fault.end || outcome.unconsumed > 0) std::printf("  OTHERWISE: %s\n", outcome.story.c_str());
  }
  return figures;
}

/// A camera that was killed and comes back at once.
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
  return 1e3 * seconds_of(HostClock::now() - back);
}

// --- scans of marked frames ---

ScanPlan plan_of(int slices) {
  ScanPlan plan = camera_fault_plan();
  plan.step = Micrometers{1.0};
  plan.slices = slices;
  return plan;
}

/// Slices that are right, of scans one after the other on one connection.
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
      ScanRunner({*camera, marked.stage(), clock, sink}).run(plan_of(slices), report, {}, {});
    } catch (const Error& error) {
      std::printf("scan of %d slices: %s\n", slices, error.what());
    }
    right += sink.slices - sink.wrong;
  }
  return right;
}

/// Triggered frames over the end of the 16-bit ids that are not there or not what they say.
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

// --- throughput ---

/// Frames a second that the simulated camera can send to somebody who reads and throws away.
double server_frames_per_s() {
  const std::string address = sim::free_camera_address();
  in_addr ip{};
  ::inet_pton(AF_INET, address.c_str(), &ip);
  sim::GvspSender sender(ntohl(ip.s_addr), 0.0, 1);
  const int sink = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr = ip;
  socklen_t length = sizeof own;
  ::bind(sink, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  ::getsockname(sink, reinterpret_cast<sockaddr*>(&own), &length);
  const std::jthread reader([sink](std::stop_token stop) {
    std::vector<char> packet(10000);
    while (!stop.stop_requested()) {
      pollfd readable{sink, POLLIN, 0};
      if (::poll(&readable, 1, 20) > 0) (void)::recv(sink, packet.data(), packet.size(), MSG_DONTWAIT);
    }
  });
  sim::PatternSource pattern(2048, 2048);
  sim::ExposureRequest request;
  request.width = request.height = 2048;
  const HostTime begin = HostClock::now();
  int frames = 0;
  for (; seconds_of(HostClock::now() - begin) < 2.0; ++frames) {
    const auto frame = sender.spare();
    frame->block_id = static_cast<std::uint64_t>(frames + 1);
    frame->width = frame->height = 2048;
    frame->packet_size = 9000;
    frame->pixels.resize(2048UL * 2048UL);
    frame->to_address = ntohl(own.sin_addr.s_addr);
    frame->to_port = ntohs(own.sin_port);
    pattern.render(request, frame->pixels);
    sender.send(frame, {});
  }
  const double per_s = frames / seconds_of(HostClock::now() - begin);
  std::printf("the camera can send %.0f frames/s (%.0f MB/s)\n", per_s, per_s * 2048 * 2048 / 1e6);
  return per_s;
}

struct Throughput {
  double frames_per_s = 0.0;
  double core_percent = 0.0;
  std::uint64_t lost = 0;
  double duration_s = 0.0;
};

Throughput run_free(double link_mbps, double rate_hz, double duration_s, bool packet_socket) {
  sim::PatternSource pattern(2048, 2048);
  const std::string address = sim::free_camera_address();
  sim::GigeCameraServer server(pattern, {.address = address, .link_mbps = link_mbps});
  CameraConfig config;
  config.address = address;
  config.packet_socket = packet_socket;
  config.packet_size_bytes = 9000;
  auto camera = open_aravis_camera(config);
  CameraSettings settings;
  settings.exposure_us = 100.0;
  settings.trigger = TriggerMode::kFreeRun;
  settings.frame_rate_hz = rate_hz;
  settings.pool_frames = 32;
  camera->configure(settings);
  const auto count_until = [&](HostTime end) {
    std::uint64_t frames = 0;
    while (HostClock::now() < end) {
      const auto frame = camera->next_frame(HostClock::now() + milliseconds(100));
      if (frame && frame->status == FrameStatus::kOk) ++frames;
    }
    return frames;
  };
  (void)count_until(HostClock::now() + milliseconds(500));
  const CameraHealth before = camera->health();
  const std::uint64_t dropped = server.frames_dropped();
  const double cpu = cpu_seconds("arv_gv_stream");
  const HostTime begin = HostClock::now();
  const std::uint64_t frames =
      count_until(begin + std::chrono::duration_cast<HostClock::duration>(std::chrono::duration<double>(duration_s)));
  Throughput result;
  result.duration_s = seconds_of(HostClock::now() - begin);
  result.frames_per_s = static_cast<double>(frames) / result.duration_s;
  result.core_percent = 100.0 * (cpu_seconds("arv_gv_stream") - cpu) / result.duration_s;
  const CameraHealth after = camera->health();
  // What the simulated sensor dropped, because the simulation could not keep up, nobody lost on the way.
  const std::uint64_t gone = after.ids_skipped - before.ids_skipped + after.frames_failed - before.frames_failed;
  result.lost = gone - std::min(gone, server.frames_dropped() - dropped);
  std::printf(
      "free run at %.0f Mb/s, %.0f Hz asked: %.1f frames/s (%.0f MB/s), receiver %.1f %% of a core, %llu lost, "
      "%llu dropped at the sensor\n",
      link_mbps, rate_hz, result.frames_per_s, result.frames_per_s * 2048 * 2048 / 1e6, result.core_percent,
      static_cast<unsigned long long>(result.lost), static_cast<unsigned long long>(server.frames_dropped()));
  return result;
}

// --- speed of scans ---

class NoSink final : public SliceSink {
 public:
  [[nodiscard]] bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
    const Slice taken = std::move(slice);
    return true;
  }
};

/// Seconds of a scan of 200 slices of 1024 x 1024 at 5 ms, the stage at once where it should be.
double step_scan_s(bool computing) {
  MarkedCamera marked(1024, 1024);
  CameraConfig config = marked.config();
  config.packet_size_bytes = 8000;
  auto camera = open_aravis_camera(config);
  CameraSettings settings;
  settings.exposure_us = 5000.0;
  camera->configure(settings);
  SystemClock clock;
  WorkerPool pool(1);
  StreamingFocusStack stack(1024, 1024, PixelFormat::kMono8, FocusSettings{}, pool);
  NoSink none;
  FocusWorker worker(stack, 8);
  SliceSink& sink = computing ? static_cast<SliceSink&>(worker) : none;
  ScanReport report;
  const HostTime begin = HostClock::now();
  ScanRunner({*camera, marked.stage(), clock, sink}).run(plan_of(200), report, {}, {});
  const double took = seconds_of(HostClock::now() - begin);
  worker.finish();
  return took;
}

double slices_per_s() {
  MarkedCamera marked(480, 360);
  CameraConfig config = marked.config();
  config.packet_size_bytes = 8000;
  auto camera = open_aravis_camera(config);
  CameraSettings settings;
  settings.exposure_us = 5000.0;
  camera->configure(settings);
  SystemClock clock;
  CheckingSink sink;
  ScanReport report;
  const HostTime begin = HostClock::now();
  ScanRunner({*camera, marked.stage(), clock, sink}).run(plan_of(200), report, {}, {});
  const double took = seconds_of(HostClock::now() - begin);
  std::printf("step scan: %d slices, %d wrong, in %.2f s\n", sink.slices, sink.wrong, took);
  return 200.0 / took;
}

// --- in one motion ---

sim::PlantOptions plant_options() {
  sim::PlantOptions options;
  options.axis = {.encoder_noise_um = 0.01, .settle_noise_um = 0.02, .start_latency_ms = 3.0};
  return options;
}

Config daemon_config(const sim::Plant& plant, const std::filesystem::path& folder) {
  const LoadedConfig loaded =
      load_config(FVD_SOURCE_DIR "/config/fvd-sim.json",
                  {"camera.address=" + plant.camera_address(), "stage.port=" + std::to_string(plant.stage_port()),
                   "rpc.port=0", "log.level=error", "paths.state_dir=" + (folder / "state").string(),
                   "paths.runtime_dir=" + (folder / "run").string()});
  return loaded.config;
}

struct Motion {
  double speedup = 0.0;
  double error_ratio = 0.0;
};

/// Time and error of a scan that begins with the stage below its first slice, as after the scan before.
struct Scanned {
  double seconds = 0.0;
  double rms_um = 0.0;
};

class Bench {
 public:
  Bench()
      : config_(daemon_config(plant_, folder_.path())),
        camera_(open_camera(config_.camera)),
        stage_(open_stage(config_.stage)) {
    stage_->home({});
  }

  Scanned scan(const Recipe& recipe) {
    stage_->move_to(Micrometers{recipe.start_um} - stage_->info().take_up, SettleCriterion{}, {});
    ResultData result;
    result.focus = focus_settings(recipe);
    result.peak = recipe.peak;
    MeasurementObserver observer;
    observer.on_phase = [](std::string_view) {};
    observer.on_slice = [](const ScanReport&) {};
    observer.on_acquired = [] {};
    measure(recipe, {*camera_, *stage_, clock_, pool_, 8}, observer, result, {});
    AtomicDirectory directory(folder_.path() / ("result" + std::to_string(++scans_)));
    write_result(directory, result);
    directory.commit();
    std::ostringstream out;
    sim::evaluate(sim::WorldParameters{}, directory.final_dir(), true, out);
    std::string text = out.str();
    text.pop_back();
    const json figures = json::parse(text.substr(text.rfind('\n') + 1));
    const auto plateau = figures["plateau_rms_um"]["five_sample"].get<double>();
    const auto ramp = figures["ramp_rms_um"]["five_sample"].get<double>();
    std::printf("%-10s %.3f s, %llu of %d slices, RMS %.4f um on plateaus, %.4f um on the ramp\n",
                recipe.mode == ScanMode::kContinuous ? "continuous" : "steps", result.times.scan_ms / 1000.0,
                static_cast<unsigned long long>(result.frames.ok), recipe.slices, plateau, ramp);
    return {result.times.scan_ms / 1000.0, std::sqrt((plateau * plateau + ramp * ramp) / 2.0)};
  }

 private:
  sim::Plant plant_{plant_options()};
  ScratchDir folder_;
  Config config_;
  std::unique_ptr<Camera> camera_;
  std::unique_ptr<Axis> stage_;
  SystemClock clock_;
  WorkerPool pool_{2};
  int scans_ = 0;
};

Motion run_motion() {
  Bench bench;
  Recipe moving =
      parse_recipe(read_text_file(FVD_SOURCE_DIR "/config/recipes/chapter_continuous.json"), "chapter_continuous");
  Recipe stopping = moving;
  stopping.mode = ScanMode::kStep;
  double moving_s = 0.0;
  double moving_um = 0.0;
  double stopping_s = 0.0;
  double stopping_um = 0.0;
  constexpr int kRepeats = 3;
  for (int good = 0, i = 0; good < kRepeats && i < 3 * kRepeats; ++i) {
    try {
      const Scanned fast = bench.scan(moving);
      const Scanned slow = bench.scan(stopping);
      moving_s += fast.seconds;
      moving_um += fast.rms_um;
      stopping_s += slow.seconds;
      stopping_um += slow.rms_um;
      ++good;
    } catch (const Error& error) {
      std::printf("a scan failed: %s\n", error.what());
    }
  }
  return {stopping_s / moving_s, moving_um / stopping_um};
}

/// Position taken for a frame minus where the stage truly was in the middle of its exposure.
void print_position_error() {
  class ErrorSink final : public SliceSink {
   public:
    explicit ErrorSink(const sim::AxisModel& axis) : axis_(axis) {}
    [[nodiscard]] bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
      const Slice taken = std::move(slice);
      const HostTime middle = taken.frame.exposure_start + (taken.frame.exposure_end - taken.frame.exposure_start) / 2;
      errors.push_back(taken.z_um - axis_.true_position_um(middle));
      return true;
    }
    std::vector<double> errors;

   private:
    const sim::AxisModel& axis_;
  };
  sim::Plant plant(plant_options());
  const ScratchDir folder;
  const Config config = daemon_config(plant, folder.path());
  const auto camera = open_camera(config.camera);
  const auto stage = open_stage(config.stage);
  stage->home({});
  CameraSettings settings;
  settings.exposure_us = 2000.0;
  settings.pool_frames = 24;
  const CameraSettings in_force = camera->configure(settings);
  SystemClock clock;
  ErrorSink sink(plant.axis());
  ScanPlan plan;
  plan.mode = ScanMode::kContinuous;
  plan.start = Micrometers{-20.0};
  plan.step = Micrometers{2.0};
  plan.slices = 101;
  plan.speed_um_per_s = 400.0;
  plan.allowed_lost_slices = 20;
  ScanReport report;
  ContinuousScan({*camera, *stage, clock, sink}, in_force).run(plan, report, {}, {});
  double sum = 0.0;
  double squares = 0.0;
  double worst = 0.0;
  for (const double error : sink.errors) {
    sum += error;
    squares += error * error;
    worst = std::max(worst, std::abs(error));
  }
  const auto n = static_cast<double>(sink.errors.size());
  std::printf("position at mid-exposure at 400 um/s: %d slices, mean error %+.4f um, sd %.4f um, worst %.4f um\n",
              static_cast<int>(n), sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)), worst);
}

int run() {
  const FaultFigures faults = run_faults();
  const double killed_ms = recover_after_kill();
  const int loss5 = right_slices(0.05, 1, 100);
  const int restarts = right_slices(0.0, 5, 20);
  const int wrap_lost = lost_over_the_wrap(70000);
  const double server = server_frames_per_s();
  const Throughput open = run_free(0.0, server, 4.0, true);
  const Throughput gigabit = run_free(1000.0, 28.0, 10.0, false);
  const double per_s = slices_per_s();
  double without = 1e9;
  double with = 1e9;
  for (int i = 0; i < 3; ++i) {
    without = std::min(without, step_scan_s(false));
    with = std::min(with, step_scan_s(true));
  }
  print_position_error();
  const Motion motion = run_motion();
  const nlohmann::ordered_json figures{
      {"fault_cases", faults.cases},
      {"wrong_slices_accepted", faults.wrong},
      {"accounting_violations", faults.violations},
      {"loss5_ok_of_100", loss5},
      {"restarts_ok_of_100", restarts},
      {"id_wrap_lost", wrap_lost},
      {"throughput_over_server", open.frames_per_s / server},
      {"receive_core_percent_at_118mb", gigabit.core_percent},
      {"slices_per_s_5ms", per_s},
      {"overlap_ratio", with / without},
      {"continuous_speedup", motion.speedup},
      {"continuous_error_ratio", motion.error_ratio},
      {"recover_ms_after_restart", std::max(killed_ms, faults.recover_ms)},
      {"hang_detect_ms", faults.hang_ms},
  };
  std::cout << figures.dump() << std::endl;
  return 0;
}

int soak() {
  const Throughput result = run_free(1000.0, 28.0, 600.0, false);
  std::cout << json{{"soak_s", result.duration_s},
                    {"soak_frames_per_s", result.frames_per_s},
                    {"soak_lost", result.lost},
                    {"soak_receive_core_percent", result.core_percent}}
                   .dump()
            << std::endl;
  return result.lost == 0 ? 0 : 1;
}

}  // namespace
}  // namespace fvd::test

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  spdlog::set_level(spdlog::level::err);
  const std::string part = argc > 1 ? argv[1] : "";
  if (part == "soak") return fvd::test::soak();
  if (part == "motion") {
    fvd::test::print_position_error();
    const auto motion = fvd::test::run_motion();
    std::printf("speedup %.2f, error ratio %.3f\n", motion.speedup, motion.error_ratio);
    return 0;
  }
  if (part == "throughput") {
    const double server = fvd::test::server_frames_per_s();
    for (const double share : {1.0, 0.9, 0.8}) (void)fvd::test::run_free(0.0, share * server, 4.0, true);
    (void)fvd::test::run_free(0.0, 0.9 * server, 4.0, false);
    return 0;
  }
  return fvd::test::run();
}
