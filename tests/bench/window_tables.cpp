#include "tests/bench/window_tables.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "core/focus/fit/smooth_heights.hpp"
#include "core/focus/lateral_period.hpp"
#include "tests/bench/chapter_figures.hpp"
#include "tests/bench/lateral_scans.hpp"

namespace fvd::bench {

namespace fs = std::filesystem;

void operator_table(const fs::path& data, WorkerPool& pool) {
  std::puts(
      "Operators and windows, five samples: chapter's scene um, plateaus and ramp; generated stacks, slices, unmasked");
  sim::WorldParameters world;
  for (const int side : {5, 7, 9}) {
    for (const FocusOperator op : {FocusOperator::kModifiedLaplacian, FocusOperator::kDiagonalLaplacian}) {
      for (const FocusWindow window : kAllFocusWindows) {
        FocusSettings settings{.focus_operator = op, .window = window, .window_px = side};
        WorldScan scan(world);
        const auto stack = scan.scan(-7.0, 10.0, 21, settings, pool);
        const ChapterFigures figures = chapter_figures(scan.surface(), stack->finish(PeakMethod::kFiveSample));
        std::printf("%-18s  %-10s  %d px  %.3f  %.3f  sigma %.2f  %.2f", std::string(focus_operator_name(op)).c_str(),
                    std::string(focus_window_name(window)).c_str(), side, figures.plateaus.rms(), figures.ramp.rms(),
                    figures.plateaus.sigma_ratio(), figures.ramp.sigma_ratio());
        settings.min_prominence = 0.0;
        settings.min_significance = 0.0;
        for (const Reference& reference : kReferences) {
          if (!fs::exists(data / reference.folder)) continue;
          const ReferenceScan references(data / reference.folder, reference, settings, pool);
          std::printf("  %.4f", references.figures(PeakMethod::kFiveSample).rms());
        }
        std::puts("");
      }
    }
  }
}

void smooth_table(const fs::path& data, WorkerPool& pool) {
  std::puts("Smoothed heights: window, weights' sigma px, chapter's plateaus and ramp um, generated stacks, slices");
  for (const int side : {5, 7}) {
    for (const double sigma_px : {2.0, 3.0, 4.0}) {
      FocusSettings settings{
          .focus_operator = FocusOperator::kDiagonalLaplacian, .window = FocusWindow::kDoubleBox, .window_px = side};
      for (const FocusWindow window : kAllFocusWindows) {
        settings.window = window;
        const auto smooth = [&](HeightMap map) {
          SmoothedHeights smoothed =
              smooth_heights(map.height_m, map.sigma_m, {sigma_px, window_area_px2(settings)}, pool);
          map.height_m = std::move(smoothed.height_m);
          map.sigma_m = std::move(smoothed.sigma_m);
          return map;
        };
        WorldScan scan({});
        const auto stack = scan.scan(-7.0, 10.0, 21, settings, pool);
        const ChapterFigures figures = chapter_figures(scan.surface(), smooth(stack->finish(PeakMethod::kFiveSample)));
        std::printf("%-10s %d px  %.0f px  %.3f  %.3f  sigma %.2f  %.2f",
                    std::string(focus_window_name(window)).c_str(), side, sigma_px, figures.plateaus.rms(),
                    figures.ramp.rms(), figures.plateaus.sigma_ratio(), figures.ramp.sigma_ratio());
        FocusSettings open = settings;
        open.min_prominence = 0.0;
        open.min_significance = 0.0;
        for (const Reference& reference : kReferences) {
          if (!fs::exists(data / reference.folder)) continue;
          const ReferenceScan references(data / reference.folder, reference, open, pool);
          const ErrorSum errors = references.figures_of(smooth(references.map(PeakMethod::kFiveSample)));
          std::printf("  %.4f (%.2f)", errors.rms(), errors.sigma_ratio());
        }
        std::puts("");
      }
    }
  }
}

void lateral_table(WorkerPool& pool, nlohmann::ordered_json& json) {
  std::puts("Lateral period of 50 %, px: operator, window, side, distance, smoothing: measured, formula");
  double worst = 0.0;
  const auto line = [&](const FocusSettings& settings, std::optional<double> smooth_px) {
    const double measured = measured_lateral_period_px(settings, smooth_px, pool);
    const double formula = lateral_period_px(settings, smooth_px);
    worst = std::max(worst, std::abs(formula / measured - 1.0));
    std::printf("%-20s %-10s %2d  %d  %4.1f  %6.2f  %6.2f\n",
                std::string(focus_operator_name(settings.focus_operator)).c_str(),
                std::string(focus_window_name(settings.window)).c_str(), settings.window_px, settings.distance_px,
                smooth_px.value_or(0.0), measured, formula);
  };
  for (const FocusOperator op :
       {FocusOperator::kModifiedLaplacian, FocusOperator::kDiagonalLaplacian, FocusOperator::kTenengrad}) {
    for (const FocusWindow window : kAllFocusWindows) {
      for (const int side : {5, 9, 13}) {
        for (const int distance : {1, 2, 3})
          line({.focus_operator = op, .window = window, .window_px = side, .distance_px = distance}, {});
      }
    }
  }
  for (const double smooth_px : {2.0, 3.0, 4.0, 4.5}) line({.window_px = 5}, smooth_px);
  json["lateral_period_px"] = measured_lateral_period_px({}, {}, pool);
  json["lateral_formula_worst"] = worst;
}

}  // namespace fvd::bench
