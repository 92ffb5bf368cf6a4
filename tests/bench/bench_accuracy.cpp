/// How near heights come to the truth, and to what can be reached at all. Tables over peak methods, neighbour
/// distances, textures, noise and steps; the last line is one JSON object of the default's figures.

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/bench/accuracy_scans.hpp"
#include "tests/bench/chapter_figures.hpp"
#include "tests/bench/model_curve.hpp"
#include "tests/bench/window_tables.hpp"

namespace fvd::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::array kMethods{PeakMethod::kParabola, PeakMethod::kLogParabola, PeakMethod::kInverseRoot,
                              PeakMethod::kFiveSample};

std::string name(PeakMethod method) { return std::string(peak_method_name(method)); }

bool is_default(PeakMethod method, int distance) {
  return method == PeakMethod::kFiveSample && distance == FocusSettings{}.distance_px;
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

/// Height errors less their mean and the stretch with height, which no scan can tell from a stage's.
ErrorSum heights_over_line(const sim::Surface& surface, const HeightMap& map) {
  double n = 0.0;
  double sz = 0.0;
  double se = 0.0;
  double szz = 0.0;
  double sze = 0.0;
  const auto each = [&](auto action) {
    for (int y = 8; y < map.mask.height() - 8; ++y) {
      for (int x = 8; x < map.mask.width() - 8; ++x) {
        const auto region = static_cast<sim::Region>(surface.region.at(x, y));
        if (map.mask.at(x, y) != 0 || region == sim::Region::kNone || region == sim::Region::kPoor) continue;
        const double truth = static_cast<double>(surface.height_um.at(x, y));
        action(truth, static_cast<double>(map.height_m.at(x, y)) * 1e6 - truth);
      }
    }
  };
  each([&](double z, double e) {
    n += 1.0;
    sz += z;
    se += e;
    szz += z * z;
    sze += z * e;
  });
  const double spread = szz - sz * sz / n;
  const double slope = spread > 1.0 ? (sze - sz * se / n) / spread : 0.0;
  ErrorSum errors;
  each([&](double z, double e) { errors.add(e - se / n - slope * (z - sz / n), 0.0); });
  return errors;
}

/// RMS of actual less reported z over the samples that were corrected, less what grows with z and its square, which no
/// scan can tell; before and after.
std::pair<double, double> frame_errors(const std::vector<double>& actual, double step,
                                       const std::vector<double>& offsets) {
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> place;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    if (offsets[k] == 0.0) continue;  // not seen
    const double reported = std::round((-40.0 + step * static_cast<double>(k)) * 100) / 100;
    before.push_back(actual[k] - reported);
    after.push_back(actual[k] - reported - offsets[k]);
    place.push_back(reported);
  }
  const auto rms = [&](const std::vector<double>& values) {
    cv::Mat powers(static_cast<int>(values.size()), 3, CV_64F);
    cv::Mat errors(static_cast<int>(values.size()), 1, CV_64F);
    for (int i = 0; i < powers.rows; ++i) {
      const double x = place[static_cast<std::size_t>(i)] / place.back();
      powers.at<double>(i, 0) = 1.0;
      powers.at<double>(i, 1) = x;
      powers.at<double>(i, 2) = x * x;
      errors.at<double>(i) = values[static_cast<std::size_t>(i)];
    }
    cv::Mat slow;
    cv::solve(powers, errors, slow, cv::DECOMP_SVD);
    return cv::norm(errors - powers * slow) / std::sqrt(powers.rows);
  };
  return {rms(before), rms(after)};
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

/// The axis is off by 10 % of the step and does not know it. Gain: frame-z error before over after.
void correction_table(WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts("Stage correction, step 0.2 widths: frame-z error um before and after, RMS of heights um without and with");
  double gain = 1e9;
  double worst = 0.0;
  struct World {
    const char* name;
    sim::SurfaceKind kind;
    double tilt;
  };
  constexpr double kStep_um = 7.6;
  for (const World& kind :
       {World{"flat", sim::SurfaceKind::kTilted, 0.0}, World{"tilted", sim::SurfaceKind::kTilted, 0.25},
        World{"rough", sim::SurfaceKind::kRough, 0.0}, World{"stepped", sim::SurfaceKind::kChapter, 0.0}}) {
    for (const double jitter : {0.0, 0.1}) {
      sim::WorldParameters world;
      world.surface = kind.kind;
      world.tilt_x_um_per_px = kind.tilt;
      world.base_um = 60.0;
      world.sq_um = 15.0;
      WorldScan scan(world);
      const int slices = static_cast<int>(260.0 / kStep_um);
      std::mt19937 random(7);
      std::normal_distribution<double> normal(0.0, jitter * kStep_um);
      std::vector<double> actual;
      const auto where = [&](int, double z) {
        return actual.emplace_back(std::round((z + normal(random)) * 100) / 100);
      };
      const auto stack = scan.scan(-40.0, kStep_um, slices, {}, pool, where);
      FocusSettings without;
      without.stage_correction = false;
      actual.clear();
      random.seed(7);
      normal.reset();
      WorldScan again(world);
      const auto plain = again.scan(-40.0, kStep_um, slices, without, pool, where);
      const HeightMap corrected = stack->finish(PeakMethod::kFiveSample);
      const ErrorSum with_sum = heights_over_line(scan.surface(), corrected);
      const ErrorSum without_sum = heights_over_line(scan.surface(), plain->finish(PeakMethod::kFiveSample));
      std::printf("%-8s jitter %.1f  %s  offsets %.3f +- %.3f um  RMS %.3f -> %.3f", kind.name, jitter,
                  corrected.stage.applied ? "on " : "off", corrected.stage.rms_um, corrected.stage.standard_error_um,
                  without_sum.rms(), with_sum.rms());
      worst = std::max(worst, with_sum.rms() / without_sum.rms());
      if (corrected.stage.applied && jitter > 0.0) {
        const auto [before, after] = frame_errors(actual, kStep_um, corrected.stage.offsets_um);
        std::printf("  frames %.3f -> %.3f um", before, after);
        gain = std::min(gain, before / after);
      }
      std::printf("  %s\n", corrected.stage.reason.c_str());
    }
  }
  json["self_correction_gain"] = gain;
  json["self_correction_worst"] = worst;
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
    const HeightMap map = scan.map(PeakMethod::kFiveSample);
    const ErrorSum kept = scan.figures_of(map);
    const auto note = [&json](const char* least, const char* most, double ratio) {
      json[least] = std::min(json.value(least, 1e9), ratio);
      json[most] = std::max(json.value(most, 0.0), ratio);
    };
    note("sigma_ratio_min", "sigma_ratio_max", kept.sigma_ratio());
    std::printf("%-16s  predicted over observed by quarters of the points from level to steep:", reference.folder);
    for (const ErrorSum& quarter : scan.quarters_of(map)) {
      std::printf("  %.2f", quarter.sigma_ratio());
      note("sigma_slope_quarter_min", "sigma_slope_quarter_max", quarter.sigma_ratio());
    }
    std::puts("");
    std::printf("%-16s  masked: %.4f, %.2f %% kept, largest error %.3f, predicted over observed %.2f; stage: %s\n",
                reference.folder, kept.rms(), 100.0 * kept.count / scan.points(), kept.largest, kept.sigma_ratio(),
                scan.stage_reason().c_str());
  }
}

}  // namespace
}  // namespace fvd::bench

int main(int argc, char** argv) try {
  nlohmann::ordered_json json;
  fvd::WorkerPool pool(2);
  const char* const data = argc > 1 ? argv[1] : FVD_SOURCE_DIR "/../shared/data";
  if (argc > 2) {  // the tables that take long, on their own
    fvd::bench::lateral_table(pool, json);
    std::puts(json.dump().c_str());
    return 0;
  }
  fvd::bench::operator_table(data, pool);
  fvd::bench::smooth_table(data, pool);
  fvd::bench::chapter_table(pool, json);
  fvd::bench::ripple_table(pool, json);
  fvd::bench::bound_table(json);
  fvd::bench::sigma_table(pool, json);
  fvd::bench::correction_table(pool, json);
  fvd::bench::reference_table(data, pool, json);
  std::puts(json.dump().c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
  return 1;
}
