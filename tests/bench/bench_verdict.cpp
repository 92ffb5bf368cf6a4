/// How long a verdict takes after the last frame of a scan of 2448 x 2048 pixels with three measurements, and where the
/// time goes: the same functions as in the daemon, from the push of the last slice to the row that clients see.
///   build/tests/bench/bench_verdict FOLDER [RUNS]     FOLDER: on the disk that results are written to
/// The last line is one JSON object; ms, medians over the runs. The first run, whose memory is new, is left out.

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

constexpr const char* kRecipe = R"({"format": 2,
  "acquire": {"scan": {"start_um": 0, "step_um": 2, "slices": 24}, "camera": {"width_px": 2448, "height_px": 2048}},
  "reconstruct": {"lateral": {"pixel_pitch_x_um": 0.5, "pixel_pitch_y_um": 0.5}},
  "evaluation": {
    "surfaces": {"level": {"steps": [{"op": "level", "form": "plane"}]}},
    "regions": {"a": {"rectangle_um": {"x": 50, "y": 50, "width": 400, "height": 900}},
                "b": {"rectangle_um": {"x": 700, "y": 50, "width": 400, "height": 900}}},
    "measurements": {
      "step": {"kind": "step_between", "surface": "level", "lower": "a", "upper": "b", "slope": "common_plane",
               "limits": {"height_um": {"lower": -5, "upper": 5}}},
      "land": {"kind": "areal", "surface": "level", "region": "a", "parameters": ["Sa", "Sq", "Sz"]},
      "line": {"kind": "profile", "from_um": [20, 500], "to_um": [1200, 500], "parameters": ["Ra"], "nesting_um": 80}}},
  "export": ["tiff", "mask.png", "texture.png", "step_log.csv", "gsf", "x3p", "preview.png", "report.pdf"]})";

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
      : folder_(folder), store_(folder / "bench_verdict.sqlite"), slices_(make_scan()) {}

  std::map<std::string, double> run(int number) {
    const Recipe recipe = parse_recipe(kRecipe, "bench");
    ResultData data;
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
    evaluate_as_asked(recipe, pool_, data);
    laps.lap("evaluate_ms");
    FirstFiles files = write_first_files(directory, data);
    laps.lap("encode_and_write_ms");
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
    return laps.times;
  }

 private:
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

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_verdict FOLDER [RUNS]\n");
    return 64;
  }
  const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 9;
  std::map<std::string, std::vector<double>> all;
  fvd::bench::Bench bench(argv[1]);
  for (int number = 1; number <= runs + 1; ++number) {
    const auto times = bench.run(number);
    std::printf("%d: %.1f ms\n", number, times.at("last_frame_to_verdict_ms"));
    if (number == 1) continue;
    for (const auto& [name, ms] : times) all[name].push_back(ms);
  }
  nlohmann::ordered_json json;
  for (const auto& [name, values] : all) json[name] = std::round(10.0 * fvd::bench::median(values)) / 10.0;
  std::cout << json.dump() << std::endl;
}
