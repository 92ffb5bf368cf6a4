/// How long a verdict takes after the last frame of a scan of 2448 x 2048 pixels with three measurements, and where the
/// time goes: the same functions as in the daemon, from the push of the last slice to the row that clients see.
///   build/tests/bench/bench_verdict FOLDER [RUNS]     FOLDER: on the disk that results are written to
/// The last line is one JSON object; ms, medians over the runs. The first run, whose memory is new, is left out.
/// last_frame_to_verdict_ms: the recipe of a line; with_profile_ms: one with a profile, whose U is drawn 200 times.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "daemon/jobs/follow_result.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/store/job_store.hpp"

namespace fvd::bench {
namespace {

constexpr int kWidth = 2448;
constexpr int kHeight = 2048;
constexpr int kSlices = 24;
constexpr double kStep_um = 2.0;

constexpr const char* kHead = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 2, "slices": 24}, "camera": {"width_px": 2448, "height_px": 2048}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
  "export": ["tiff", "mask.png", "texture.png", "step_log.csv", "gsf", "x3p", "preview.png", "report.pdf"],
  "evaluation": {
    "regions": {"a": {"rectangle_um": {"x": 50, "y": 50, "width": 400, "height": 900}},
                "b": {"rectangle_um": {"x": 700, "y": 50, "width": 400, "height": 900}}},)";

/// As in a line: points of large standard error left out, levelled to one land, the step to the other and the roughness
/// of both, with limits. Regions of 1.4 million points each.
constexpr const char* kLine = R"(
    "surfaces": {"level": {"steps": [{"op": "mask_sigma", "max_sigma_um": 1.0}, {"op": "level", "regions": ["a"]}]}},
    "measurements": {
      "step": {"kind": "step_between", "surface": "level", "lower": "a", "upper": "b", "slope": "common_plane",
               "limits": {"height_um": {"lower": -5, "upper": 5}}},
      "land": {"kind": "areal", "surface": "level", "region": "a", "parameters": ["Sa", "Sq"],
               "limits": {"Sa_um": {"upper": 20}}},
      "back": {"kind": "areal", "surface": "level", "region": "b", "parameters": ["Sa", "Sq"],
               "limits": {"Sq_um": {"upper": 20}}}}}})";

/// The same number of measurements, one of which has the noise of 200 draws.
constexpr const char* kProfile = R"(
    "surfaces": {"level": {"steps": [{"op": "level"}]}},
    "measurements": {
      "step": {"kind": "step_between", "surface": "level", "lower": "a", "upper": "b", "slope": "common_plane",
               "limits": {"height_um": {"lower": -5, "upper": 5}}},
      "land": {"kind": "areal", "surface": "level", "region": "a", "parameters": ["Sa", "Sq", "Sz"]},
      "line": {"kind": "profile", "from_um": [20, 500], "to_um": [1200, 500], "parameters": ["Ra"], "nesting_um": 80}}}})";

/// What a scan with an encoder knows of its slices, so that their errors are in U.
StepLog known_steps() {
  StepLog steps;
  for (int k = 0; k < kSlices; ++k) {
    StepRecord step;
    step.measured = true;
    step.commanded_um = step.measured_um = k * kStep_um;
    step.measured_sd_um = 0.02;
    step.position_samples = 8;
    steps.push_back(step);
  }
  return steps;
}

/// A measurement that was not made would be fast.
void require_made(const Evaluation& evaluation) {
  for (const auto& [name, made] : evaluation.measurements) {
    if (!made.reason.empty()) throw std::runtime_error(name + ": " + made.reason);
    for (const auto& [key, value] : made.values) {
      if (!value.u) throw std::runtime_error(name + ": " + key + " has no U");
    }
  }
}

/// Grain whose contrast rises and falls at its own height in every column, and noise.
std::vector<Plane<std::uint8_t>> make_scan() {
  std::mt19937 random(1);
  std::vector<float> grain(static_cast<std::size_t>(kWidth) * kHeight);
  for (float& value : grain) value = static_cast<float>(random() % 201) - 100.0F;
  std::vector<Plane<std::uint8_t>> slices;
  for (int k = 0; k < kSlices; ++k) {
    auto& slice = slices.emplace_back(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float u = (static_cast<float>(k) - 3.0F - 18.0F * static_cast<float>(x) / kWidth) / 2.0F;
        const float contrast = 1.0F / ((1.0F + 0.4F * u * u) * (1.0F + 0.4F * u * u));
        const std::size_t i = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        slice.at(x, y) = static_cast<std::uint8_t>(126.0F + contrast * grain[i] + static_cast<float>(random() & 3U));
      }
    }
  }
  return slices;
}

/// Names the time since the time before.
class Laps {
 public:
  void lap(const char* name) {
    const auto now = std::chrono::steady_clock::now();
    times[name] = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }
  [[nodiscard]] double total_ms() const { return std::chrono::duration<double, std::milli>(last_ - begin_).count(); }
  std::map<std::string, double> times;

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = begin_;
};

class Bench {
 public:
  explicit Bench(const std::filesystem::path& folder)
      : folder_(folder), store_(new_database(folder)), slices_(make_scan()) {}

  std::map<std::string, double> run(int number, const char* evaluation) {
    const Recipe recipe = parse_recipe(std::string(kHead) + evaluation, "bench");
    ResultData data;
    data.steps = known_steps();
    data.encoder_resolution_um = 0.05;
    note_recipe(recipe, data);
    data.created = std::chrono::system_clock::now();
    JobStatus job = store_.accept({number, "part", "bench"});
    data.job_id = job.job_id;
    AtomicDirectory directory(folder_ / job.job_id);
    StreamingFocusStack stack(kWidth, kHeight, PixelFormat::kMono8, focus_settings(recipe), pool_, false, pages_);
    const auto push = [&](int k) {
      stack.push(image_view(slices_[static_cast<std::size_t>(k)].view(), PixelFormat::kMono8), k * kStep_um);
    };
    for (int k = 0; k + 1 < kSlices; ++k) push(k);
    Laps laps;
    push(kSlices - 1);
    laps.lap("last_slice_ms");
    reconstruct(stack, recipe, data);
    laps.lap("finish_ms");
    FirstFilesWriter writer(directory, data);
    evaluate_as_asked(recipe, pool_, data, pages_);
    laps.lap("evaluate_ms");
    FirstFiles files = writer.finish();
    laps.lap("files_after_it_ms");
    directory.commit();
    laps.lap("sync_ms");
    job.state = JobState::kCompleted;
    const std::string text = result_text(directory);
    store_.finish(job, directory.final_dir().string(), text, true);
    laps.lap("row_ms");
    laps.times["last_frame_to_verdict_ms"] = laps.total_ms();
    const auto begin = std::chrono::steady_clock::now();
    (void)follow_result({job.job_id, directory.final_dir(), text, std::move(files.written)}, {});
    laps.times["following_files_ms"] =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    std::filesystem::remove_all(directory.final_dir());
    require_made(data.evaluation.value());
    return laps.times;
  }

 private:
  static std::filesystem::path new_database(const std::filesystem::path& folder) {
    for (const char* end : {"", "-wal", "-shm"}) {
      std::filesystem::remove(folder / (std::string("bench_verdict.sqlite") + end));
    }
    return folder / "bench_verdict.sqlite";
  }
  static std::string result_text(const AtomicDirectory& directory) {
    std::ifstream file(directory.final_dir() / "result.json");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
  JobStore store_;
  std::vector<Plane<std::uint8_t>> slices_;
  WorkerPool pool_{2};
  KeptPagesPtr pages_ = std::make_shared<KeptPages>(std::size_t{1} << 30U);
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Medians over the runs; numbers them on.
std::map<std::string, double> medians(Bench& bench, const char* evaluation, int runs, int& number) {
  std::map<std::string, std::vector<double>> all;
  for (int run = 0; run <= runs; ++run) {
    const auto times = bench.run(++number, evaluation);
    std::printf("%d: %.1f ms\n", number, times.at("last_frame_to_verdict_ms"));
    if (run == 0) continue;
    for (const auto& [name, ms] : times) all[name].push_back(ms);
  }
  std::map<std::string, double> found;
  for (const auto& [name, values] : all) found[name] = std::round(10.0 * median(values)) / 10.0;
  return found;
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_verdict FOLDER [RUNS]\n");
    return 64;
  }
  const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  fvd::bench::Bench bench(argv[1]);
  int number = 0;
  nlohmann::ordered_json json;
  for (const auto& [name, ms] : fvd::bench::medians(bench, fvd::bench::kLine, runs, number)) json[name] = ms;
  const auto profile = fvd::bench::medians(bench, fvd::bench::kProfile, runs, number);
  json["with_profile_ms"] = profile.at("last_frame_to_verdict_ms");
  json["with_profile_evaluate_ms"] = profile.at("evaluate_ms");
  std::cout << json.dump() << std::endl;
}
