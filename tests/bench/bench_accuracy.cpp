/// How near heights come to the truth, and to what can be reached at all. Tables over peak methods, neighbour
/// distances, textures, noise and steps; the last line is one JSON object of the default's figures.

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/accuracy_scans.hpp"
#include "tests/bench/model_curve.hpp"

namespace fvd::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMethods{PeakMethod::kParabola, PeakMethod::kLogParabola, PeakMethod::kInverseRoot,
                              PeakMethod::kFiveSample};

std::string name(PeakMethod method) { return std::string(peak_method_name(method)); }

bool is_default(PeakMethod method, int distance) {
  return method == PeakMethod::kFiveSample && distance == FocusSettings{}.distance_px;
}

struct ChapterFigures {
  ErrorSum plateaus;
  ErrorSum ramp;
  double textured = 0.0;    // points
  double poor_kept = 0.0;   // inside the texture-poor patch, away from its border
  double poor_wrong = 0.0;  // of these, off by more than 5 um
  double poor_points = 0.0;
};

ChapterFigures chapter_figures(const sim::Surface& surface, const HeightMap& map) {
  constexpr int kBorder_px = 12;  // windows and blur reach so far
  ChapterFigures figures;
  const auto inner = [&](int x, int y) {
    for (const auto& [u, v] :
         {std::pair{x - kBorder_px, y}, {x + kBorder_px, y}, {x, y - kBorder_px}, {x, y + kBorder_px}}) {
      if (u < 0 || v < 0 || u >= map.mask.width() || v >= map.mask.height()) return false;
      if (static_cast<sim::Region>(surface.region.at(u, v)) != sim::Region::kPoor) return false;
    }
    return true;
  };
  for (int y = 0; y < map.mask.height(); ++y) {
    for (int x = 0; x < map.mask.width(); ++x) {
      const auto region = static_cast<sim::Region>(surface.region.at(x, y));
      const double error_um =
          static_cast<double>(map.height_m.at(x, y)) * 1e6 - static_cast<double>(surface.height_um.at(x, y));
      const double sigma_um = static_cast<double>(map.sigma_m.at(x, y)) * 1e6;
      const bool valid = map.mask.at(x, y) == 0;
      if (region == sim::Region::kPoor && inner(x, y)) {
        ++figures.poor_points;
        figures.poor_kept += valid ? 1 : 0;
        figures.poor_wrong += valid && std::abs(error_um) > 5.0 ? 1 : 0;
      }
      if (region == sim::Region::kNone || region == sim::Region::kPoor) continue;
      ++figures.textured;
      if (valid) (region == sim::Region::kRamp ? figures.ramp : figures.plateaus).add(error_um, sigma_um);
    }
  }
  return figures;
}

void chapter_table(WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts("Chapter's scene, 9 x 9, step 10 um, um: RMS and bias on the plateaus, RMS on the ramp");
  for (const double noise : {0.5, 1.5, 3.0}) {
    for (const int distance : {1, 2, 3}) {
      sim::WorldParameters world;
      world.readout_noise = noise;
      WorldScan scan(world);
      const auto stack = scan.scan(-7.0, 10.0, 21, {.distance_px = distance}, pool);
      for (const PeakMethod method : kMethods) {
        const ChapterFigures figures = chapter_figures(scan.surface(), stack->finish(method));
        std::printf("noise %.1f  distance %d  %-12s  %.3f  %+.3f  %.3f\n", noise, distance, name(method).c_str(),
                    figures.plateaus.rms(), figures.plateaus.bias(), figures.ramp.rms());
        if (noise != 1.5 || !is_default(method, distance)) continue;
        json["chapter_plateau_rms_um"] = figures.plateaus.rms();
        json["chapter_ramp_rms_um"] = figures.ramp.rms();
        json["chapter_plateau_bias_um"] = figures.plateaus.bias();
        json["textured_kept"] = (figures.plateaus.count + figures.ramp.count) / figures.textured;
        json["poor_kept_wrong"] = figures.poor_kept > 0 ? figures.poor_wrong / figures.poor_kept : 0.0;
        std::printf("texture-poor patch: %.0f of %.0f points kept, %.0f of them off by more than 5 um\n",
                    figures.poor_kept, figures.poor_points, figures.poor_wrong);
      }
    }
  }
}

/// A noiseless plane that rises through four steps: the mean error over the fraction of a step.
void ripple_table(WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts("Bias over the fraction of a step, white texture, no noise: half its range, % of the step");
  constexpr double kWidth_um = 38.0;  // of the focus curve at the default settings
  for (const double share : {0.2, 0.33, 0.5}) {
    const double step = std::round(kWidth_um * share * 100) / 100;
    sim::WorldParameters world;
    world.surface = sim::SurfaceKind::kTilted;
    world.readout_noise = 0.0;
    world.tilt_x_um_per_px = 4.0 * step / 480;
    world.base_um = 100.0;
    WorldScan scan(world);
    const auto stack = scan.scan(-20.0, step, static_cast<int>(240.0 / step), {}, pool);
    for (const PeakMethod method : kMethods) {
      const HeightMap map = stack->finish(method);
      std::array<ErrorSum, 10> phases;
      for (int y = 8; y < map.mask.height() - 8; ++y) {
        for (int x = 8; x < map.mask.width() - 8; ++x) {
          if (map.mask.at(x, y) != 0) continue;
          const double truth = static_cast<double>(scan.surface().height_um.at(x, y));
          const double place = (truth + 20.0) / step;
          const auto phase = static_cast<std::size_t>(10.0 * (place - std::floor(place)));
          phases[phase].add(static_cast<double>(map.height_m.at(x, y)) * 1e6 - truth, 0.0);
        }
      }
      double low = 1e9;
      double high = -1e9;
      for (const ErrorSum& phase : phases) {
        low = std::min(low, phase.bias());
        high = std::max(high, phase.bias());
      }
      const double ripple = 50.0 * (high - low) / step;
      std::printf("step %.2f widths  %-12s  %.2f\n", share, name(method).c_str(), ripple);
      if (method == PeakMethod::kFiveSample && share == 0.33) json["ripple_percent_of_step"] = ripple;
    }
  }
}

void bound_table(nlohmann::ordered_json& json) {
  std::puts(
      "Model curve with 1 % noise: RMS over the Cramer-Rao bound, sigma over RMS, share of heights, slices a bin");
  const ModelCurve curve;
  for (const double u : {0.25, 0.5, 1.0, 1.5, 2.0}) std::printf("F(%.2f) = %.3f  ", u, curve.at(u));
  std::puts("");
  for (const char* step : {"0.02", "0.05", "0.1", "0.2", "0.33", "0.5", "0.7"}) {
    const BoundRatio ratio = rms_over_bound(curve, std::stod(step));
    std::printf("step %-4s  %.3f  %.3f  %.4f  %d\n", step, ratio.ratio, ratio.sigma_ratio, ratio.share,
                ratio.bin_slices);
    const std::string key = step;
    if (key == "0.05" || key == "0.1" || key == "0.2" || key == "0.33") json["rms_over_bound"][key] = ratio.ratio;
  }
}

void sigma_table(WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts(
      "Chapter's surface, default settings: RMS, um, and predicted over observed, plateaus and ramp, width, noise");
  double smallest = 1e9;
  double largest = 0.0;
  struct Texture {
    const char* name;
    sim::TextureKind kind;
    double contrast;
  };
  for (const Texture& texture :
       {Texture{"granite", sim::TextureKind::kGranite, 28.0}, Texture{"white", sim::TextureKind::kWhite, 28.0},
        Texture{"fine", sim::TextureKind::kFine, 28.0}, Texture{"low contrast", sim::TextureKind::kGranite, 10.0}}) {
    for (const double noise : {0.5, 1.5, 3.0}) {
      double curve_width = 38.0;
      for (const double share : {0.33, 0.1, 0.2, 0.33, 0.5, 0.7}) {  // the first only finds the width
        const double step = std::round(curve_width * share * 100) / 100;
        sim::WorldParameters world;
        world.readout_noise = noise;
        world.texture = texture.kind;
        world.contrast = texture.contrast;
        WorldScan scan(world);
        FocusSettings settings;
        settings.bin_slices = choose_bin_slices(step, curve_width);
        // Starts a third of a step apart: the error follows the fraction of a step, and plateaus have only three.
        ChapterFigures figures;
        HeightMap map;
        for (const double third : {0.0, 1.0, 2.0}) {
          const auto stack =
              scan.scan(-47.0 + third / 3.0 * step, step, static_cast<int>(280.0 / step), settings, pool);
          map = stack->finish(PeakMethod::kFiveSample);
          const ChapterFigures one = chapter_figures(scan.surface(), map);
          figures.plateaus.add(one.plateaus);
          figures.ramp.add(one.ramp);
        }
        if (share == 0.33) curve_width = map.curve_width_um;
        ErrorSum all = figures.plateaus;
        all.add(figures.ramp);
        std::printf(
            "%-12s  noise %.1f  step %4.1f um x %d  %.3f  %.2f  ramp %.3f  %.2f  all %.2f  width %.1f  noise %.2f\n",
            texture.name, noise, step, settings.bin_slices, figures.plateaus.rms(), figures.plateaus.sigma_ratio(),
            figures.ramp.rms(), figures.ramp.sigma_ratio(), all.sigma_ratio(), map.curve_width_um, map.noise_grey);
        smallest = std::min(smallest, all.sigma_ratio());
        largest = std::max(largest, all.sigma_ratio());
      }
    }
  }
  json["sigma_ratio_min"] = smallest;
  json["sigma_ratio_max"] = largest;
}

void reference_table(const fs::path& data, WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts("Generated stacks, 9 x 9, slices: RMS, bias, points; nothing masked, and with the default thresholds");
  for (const Reference& reference : kReferences) {
    const fs::path folder = data / reference.folder;
    if (!fs::exists(folder)) {
      std::printf("%s is not there: left out\n", folder.c_str());
      continue;
    }
    for (const int distance : {1, 2, 3}) {
      const ReferenceScan scan(folder, reference,
                               {.distance_px = distance, .min_prominence = 0.0, .min_significance = 0.0}, pool);
      for (const PeakMethod method : kMethods) {
        const ErrorSum errors = scan.figures(method);
        std::printf("%-16s  distance %d  %-12s  %.4f  %+.4f  %.0f\n", reference.folder, distance, name(method).c_str(),
                    errors.rms(), errors.bias(), errors.count);
        if (is_default(method, distance)) json[reference.key] = errors.rms();
      }
    }
    const ReferenceScan scan(folder, reference, {}, pool);
    const ErrorSum kept = scan.figures(PeakMethod::kFiveSample);
    std::printf("%-16s  masked: %.4f, %.2f %% kept, largest error %.3f, predicted over observed %.2f\n",
                reference.folder, kept.rms(), 100.0 * kept.count / scan.points(), kept.largest, kept.sigma_ratio());
  }
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) try {
  nlohmann::ordered_json json;
  fvd::WorkerPool pool(2);
  fvd::bench::chapter_table(pool, json);
  fvd::bench::ripple_table(pool, json);
  fvd::bench::bound_table(json);
  fvd::bench::sigma_table(pool, json);
  fvd::bench::reference_table(argc > 1 ? argv[1] : FVD_SOURCE_DIR "/../shared/data", pool, json);
  std::puts(json.dump().c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
  return 1;
}
