/// The scenes of run_truth.sh as folders of slices with truth: bench_truth FOLDER. truth_figures.py lets fvdctl process
/// them and judges what came out. figures.json holds what is measured here.

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/evaluate/slice_files.hpp"
#include "sim/world/surface.hpp"
#include "sim/world/world_config.hpp"
#include "tests/bench/lateral_scans.hpp"
#include "tests/bench/truth_stack.hpp"

namespace fvd::bench {
namespace {

namespace fs = std::filesystem;
using sim::TextureKind;
using Stack = std::vector<cv::Mat>;

constexpr int kSlices = 21;
constexpr double kStep_um = 10.0;

void world_scene(const fs::path& folder, const sim::WorldParameters& world, const sim::SliceFileOptions& slices) {
  (void)sim::write_slices(world, folder, slices);
  write_truth_image(folder, sim::make_surface(world).height_um);
}

/// Two planes 300 um apart, each pair of brightnesses.
void layered(const fs::path& out) {
  for (const char* name : {"bright_over_dark", "dark_over_bright", "bright_over_black", "equal"}) {
    const std::string scene = std::string("layered_") + name;
    world_scene(out / scene, sim::load_world(fs::path(FVD_SOURCE_DIR "/sim/worlds") / (scene + ".json")),
                {.start_um = 0.0, .step_um = kStep_um, .slices = 43, .format = "pgm"});
  }
}

/// The chapter's surface in four textures, and finely stepped.
void chapters(const fs::path& out) {
  const auto scene = [&](const std::string& name, TextureKind texture, double contrast, double noise,
                         const sim::SliceFileOptions& slices) {
    sim::WorldParameters world;
    world.texture = texture;
    world.contrast = contrast;
    world.readout_noise = noise;
    world_scene(out / name, world, slices);
  };
  const sim::SliceFileOptions usual{.start_um = -7.0, .step_um = 10.0, .slices = 21, .format = "pgm"};
  scene("chapter", TextureKind::kGranite, 28.0, 1.5, usual);
  scene("chapter_white", TextureKind::kWhite, 28.0, 1.5, usual);
  scene("chapter_fine", TextureKind::kFine, 28.0, 1.5, usual);
  scene("chapter_pale", TextureKind::kGranite, 10.0, 1.5, usual);
  // 0.1 widths of its focus curve.
  scene("fine_step", TextureKind::kWhite, 28.0, 1.5,
        {.start_um = -47.0, .step_um = 4.0, .slices = 65, .format = "pgm"});
}

/// The left half has a texture, the right half none.
void textureless(const fs::path& out) {
  constexpr int kWidth = 480;
  constexpr int kHeight = 240;
  constexpr int kBad = 10;
  const Camera camera{.read_noise = 0.6, .shot_variance = 0.02, .black = 10.0};
  Scene scene{surface_of(kWidth, kHeight, [](int, int y) { return 60.0 + 80.0 * y / kHeight; }),
              texture_of(kWidth, kHeight, TextureKind::kGranite, 110.0, 25.0, 3)};
  for (int y = 0; y < kHeight; ++y) std::fill_n(scene.texture.row(y) + kWidth / 2, kWidth / 2, 110.0F);
  const Stack light = light_of(scene, 0.0, kStep_um, kSlices);
  const Stack clean = exposed(light, camera, 5);
  const auto write = [&](const char* name, const Stack& stack) {
    write_stack(out / (std::string("textureless_") + name), stack, 0.0, kStep_um, scene.height_um);
  };
  write("clean", clean);
  std::mt19937_64 random(9);
  Stack dark = clean;
  dark[kBad] = exposed(cv::Mat::zeros(kHeight, kWidth, CV_32F), camera, random);
  write("dark", dark);
  Stack partial;
  for (const cv::Mat& slice : clean) partial.push_back(slice.clone());
  partial[kBad].rowRange(kHeight / 2, kHeight) = 0;
  write("partial", partial);
  Stack blinking;
  for (const cv::Mat& slice : light) blinking.push_back(slice.clone());
  for (int i = 0; i < kWidth * kHeight / 576; ++i) {
    const auto any = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    const int k = any(kSlices);
    const int y = any(kHeight);
    blinking[static_cast<std::size_t>(k)].at<float>(y, any(kWidth)) += 60.0F;
  }
  write("blink", exposed(blinking, camera, 5));
}

/// 1500 bright spots on a tilted plane, each the light of one pixel of so many times full scale, 0.8 px wide in focus.
/// The noise is such that the clean plane has an RMS of 0.37 um with a box of 9.
void glints(const fs::path& out) {
  constexpr int kWidth = 960;
  constexpr int kHeight = 640;
  constexpr double kStart_um = -20.0;
  constexpr double kFine_um = 8.0;
  constexpr double kSpot_px = 0.8;
  const Camera camera{.read_noise = 3.3};
  const Scene scene{surface_of(kWidth, kHeight, [](int x, int) { return 20.0 + 0.08 * x; }),
                    texture_of(kWidth, kHeight, TextureKind::kGranite, 110.0, 25.0, 6), 0.04};
  std::mt19937_64 random(7);
  std::vector<Glint> places;
  for (int i = 0; i < 1500; ++i) {
    const int x = static_cast<int>(random() % kWidth);
    places.push_back({x, static_cast<int>(random() % kHeight)});
  }
  const Stack light = light_of(scene, kStart_um, kFine_um, kSlices);
  for (const int times : {0, 10, 40, 200}) {
    Stack lit;
    for (int k = 0; k < kSlices; ++k) {
      lit.push_back(light[static_cast<std::size_t>(k)].clone());
      if (times > 0) add_glints(lit.back(), scene, kStart_um + kFine_um * k, places, kSpot_px, 255.0 * times);
    }
    write_stack(out / ("glint" + std::to_string(times)), exposed(lit, camera, 8), kStart_um, kFine_um, scene.height_um);
  }
}

/// A tilted plane of 80 um, steps, or a dome.
Scene small_scene(std::uint64_t seed, double grey, double contrast) {
  constexpr int kSide = 240;
  const auto height_um = [&](int x, int y) {
    if (seed % 3 == 0) return 60.0 + 40.0 * (3 * x / kSide);
    if (seed % 3 == 1) return 60.0 + 80.0 * x / kSide;
    const double square = (std::pow(x - kSide / 2, 2) + std::pow(y - kSide / 2, 2)) / std::pow(kSide / 2, 2);
    return 150.0 - 70.0 * std::min(square, 1.0);
  };
  return {surface_of(kSide, kSide, height_um),
          texture_of(kSide, kSide, TextureKind::kGranite, grey, contrast, 10 + seed)};
}

/// What happens between the slices: a lamp that flickers, a swing in one slice, a slice delivered twice, drift.
void disturbed(const fs::path& out) {
  const Camera camera;
  const Scene scene = small_scene(1, 90.0, 22.0);
  const auto write = [&](const char* name, const Stack& stack) {
    write_stack(out / name, stack, 0.0, kStep_um, scene.height_um);
  };
  const Stack light = light_of(scene, 0.0, kStep_um, kSlices);
  const Stack clean = exposed(light, camera, 1);
  write("clean", clean);
  std::mt19937_64 random(7);  // its factors vary by 10 %, over all slices and over those in focus
  std::normal_distribution<double> normal(1.0, 0.10);
  Stack flicker;
  for (const cv::Mat& slice : light) flicker.push_back(slice * normal(random));
  write("flicker10", exposed(flicker, camera, 1));
  Stack swinging = clean;
  swinging[10] = exposed(vibrated(light[10], 3.0, 0.5, false), camera, random);
  write("vibration", swinging);
  Stack repeated = clean;
  repeated[8] = repeated[7];
  write("repeated", repeated);
  Stack drift;
  for (int k = 0; k < kSlices; ++k) {
    const double shift_px = 0.44 * (k - kSlices / 2);
    const double rise_um = 80.0 / 240;
    const Scene there{surface_of(240, 240, [&](int x, int) { return 60.0 + rise_um * (x - shift_px); }),
                      moved(scene.texture, shift_px, 0.0)};
    drift.push_back(light_of(there, kStep_um * k, kStep_um, 1).front());
  }
  write("drift", exposed(drift, camera, 1));
}

/// Ten stacks each with one slice that must not be believed. Their folders end in what was planted: kind and index.
void suspects(const fs::path& out) {
  const Camera camera{.read_noise = 1.0, .shot_variance = 0.01, .black = 6.0};
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Scene scene = small_scene(seed, 100.0, 24.0);
    const Stack light = light_of(scene, 0.0, kStep_um, kSlices);
    const Stack clean = exposed(light, camera, seed);
    std::mt19937_64 random(seed + 100);
    const auto index = [&](int first, int last) {
      return static_cast<std::size_t>(first) + random() % static_cast<std::size_t>(last - first + 1);
    };
    const bool odd = seed % 2 == 1;
    const auto write = [&](const std::string& kind, const Stack& stack, std::size_t k) {
      const std::string name = "suspect_" + std::to_string(seed) + '_' + kind + '_' + std::to_string(k);
      write_stack(out / name, stack, 0.0, kStep_um, scene.height_um);
    };
    write_stack(out / ("suspect_" + std::to_string(seed) + "_clean"), clean, 0.0, kStep_um, scene.height_um);
    Stack bad = clean;
    std::size_t k = seed == 0 ? 0 : index(0, kSlices - 1);
    bad[k] = exposed(odd ? cv::Mat(light[k] * 0.3) : cv::Mat::zeros(light[k].size(), CV_32F), camera, random);
    write("dark", bad, k);
    bad = clean;
    k = index(1, kSlices - 1);
    bad[k] = clean[k].clone();
    const int first_row = static_cast<int>(index(60, 180));
    // What did not come is black, or what the buffer held before.
    if (odd) clean[k - 1].rowRange(first_row, 240).copyTo(bad[k].rowRange(first_row, 240));
    if (!odd) bad[k].rowRange(first_row, 240) = 0;
    write("half", bad, k);
    bad = clean;
    k = index(0, kSlices - 1);
    bad[k] = cv::Mat(clean[k].size(), CV_8U, cv::Scalar(std::array{0, 128, 255}[seed % 3]));
    write("constant", bad, k);
    bad = clean;
    k = index(1, kSlices - 1);
    bad[k] = bad[k - 1];
    write("repeated", bad, k);
    bad = clean;
    k = index(5, 14);
    std::swap(bad[k], bad[k + 1]);
    write("exchanged", bad, k);
    bad = clean;
    k = index(7, 13);  // parts of every surface are in focus there
    bad[k] = exposed(vibrated(light[k], 2.5 + 0.2 * static_cast<double>(seed), 0.3 * static_cast<double>(seed), odd),
                     camera, random);
    write("vibrated", bad, k);
  }
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) try {
  namespace bench = fvd::bench;
  if (argc != 2) {
    std::fputs("usage: bench_truth FOLDER (existing, empty)\n", stderr);
    return 64;
  }
  const std::filesystem::path out = argv[1];
  bench::layered(out);
  bench::chapters(out);
  bench::textureless(out);
  bench::glints(out);
  bench::disturbed(out);
  bench::suspects(out);
  fvd::WorkerPool pool(2);
  nlohmann::ordered_json figures;
  figures["smooth_period_px"] = bench::measured_lateral_period_px({.window_px = 5}, 4.4, pool);
  std::ofstream file(out / "figures.json");
  file << figures.dump() << '\n';
  return file ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_truth: %s\n", error.what());
  return 1;
}
