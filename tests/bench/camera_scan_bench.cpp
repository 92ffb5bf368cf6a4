/// Slices per second, and a scan in one motion against the same slices step by step.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

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
#include "sim/evaluate/evaluate.hpp"
#include "sim/plant/plant.hpp"
#include "tests/bench/camera_benches.hpp"
#include "tests/support/camera_fault_case.hpp"
#include "tests/support/marked_plan.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd::test {

namespace {

using nlohmann::json;

double seconds_of(HostClock::duration time) { return std::chrono::duration<double>(time).count(); }

class NoSink final : public SliceSink {
 public:
  [[nodiscard]] bool push(Slice&& slice, HostTime /*deadline*/, std::stop_token /*stop*/) override {
    const Slice taken = std::move(slice);
    return true;
  }
};

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
    observer.on_slice = [](const SliceProgress&) {};
    observer.on_acquired = [] {};
    measure(recipe, {*camera_, *stage_, clock_, pool_, nullptr, 8}, observer, result, {});
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

}  // namespace

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
  FocusWorker worker(stack, 8, 0);
  SliceSink& sink = computing ? static_cast<SliceSink&>(worker) : none;
  ScanReport report;
  const HostTime begin = HostClock::now();
  ScanRunner({*camera, marked.stage(), clock, sink}).run(marked_plan(200), report, {}, {});
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
  ScanRunner({*camera, marked.stage(), clock, sink}).run(marked_plan(200), report, {}, {});
  const double took = seconds_of(HostClock::now() - begin);
  std::printf("step scan: %d slices, %d wrong, in %.2f s\n", sink.slices, sink.wrong, took);
  return 200.0 / took;
}

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
  FreeRun free_run(*camera, in_force);
  ContinuousScan({*camera, *stage, clock, sink}, free_run).run(plan, report, {}, {});
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

}  // namespace fvd::test
