#include "core/focus/measure/focus_settings.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.hpp"

namespace fvd {

std::string_view peak_method_name(PeakMethod method) noexcept {
  switch (method) {
    case PeakMethod::kNearest:
      return "nearest";
    case PeakMethod::kParabola:
      return "parabola";
    case PeakMethod::kLogParabola:
      return "log_parabola";
    case PeakMethod::kInverseRoot:
      return "inverse_root";
    case PeakMethod::kFiveSample:
      return "five_sample";
  }
  return "nearest";
}

std::optional<PeakMethod> peak_method_from_name(std::string_view name) noexcept {
  for (const PeakMethod method : kAllPeakMethods) {
    if (name == peak_method_name(method)) return method;
  }
  return std::nullopt;
}

std::string_view focus_operator_name(FocusOperator op) noexcept {
  switch (op) {
    case FocusOperator::kModifiedLaplacian:
      return "modified_laplacian";
    case FocusOperator::kDiagonalLaplacian:
      return "diagonal_laplacian";
    case FocusOperator::kTenengrad:
      return "tenengrad";
    case FocusOperator::kIntensity:
      return "intensity";
  }
  return "modified_laplacian";
}

std::optional<FocusOperator> focus_operator_from_name(std::string_view name) noexcept {
  for (const FocusOperator op : kAllFocusOperators) {
    if (name == focus_operator_name(op)) return op;
  }
  return std::nullopt;
}

std::string_view focus_window_name(FocusWindow window) noexcept {
  switch (window) {
    case FocusWindow::kBox:
      return "box";
    case FocusWindow::kDoubleBox:
      return "double_box";
  }
  return "box";
}

std::optional<FocusWindow> focus_window_from_name(std::string_view name) noexcept {
  for (const FocusWindow window : kAllFocusWindows) {
    if (name == focus_window_name(window)) return window;
  }
  return std::nullopt;
}

WindowSides window_sides(const FocusSettings& settings) noexcept {
  const int window = settings.window_px;
  if (settings.window == FocusWindow::kBox || window < kMinWindowPx) return {window, 1};
  const auto fits = [&](int first, int second) { return first * first + second * second <= window * window + 1; };
  WindowSides sides{kMinWindowPx, 1};
  while (true) {
    const WindowSides wider = sides.first == sides.second ? WindowSides{sides.first + 2, sides.second}
                                                          : WindowSides{sides.first, sides.first};
    if (!fits(wider.first, wider.second)) return sides;
    sides = wider;
  }
}

double window_norm(const FocusSettings& settings) noexcept {
  const WindowSides sides = window_sides(settings);
  double squares = 0.0;  // of the weights along one direction; those of the window are their products
  for (int x = 0; x < sides.first + sides.second - 1; ++x) {
    const int weight = std::min({x + 1, sides.second, sides.first, sides.first + sides.second - 1 - x});
    squares += static_cast<double>(weight) * weight;
  }
  return squares;
}

double window_area_px2(const FocusSettings& settings) noexcept {
  const WindowSides sides = window_sides(settings);
  const double weights = static_cast<double>(sides.first) * sides.second;  // their sum along one direction
  const double along = weights * weights / window_norm(settings);          // px
  return along * along;
}

int choose_bin_slices(double step_um, double curve_width_um, int slices) noexcept {
  constexpr double kSampleDistance = 0.35;
  constexpr int kLeastSamples = 8;
  if (!(curve_width_um > 0.0) || !(std::abs(step_um) > 0.0)) return 1;
  const double wanted = std::floor(kSampleDistance * curve_width_um / std::abs(step_um) + 0.3);
  const int most = std::clamp(slices / kLeastSamples, 1, kMaxBinSlices);
  return static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most)));
}

namespace {

void check_point_tests(const PointTests& tests) {
  const auto check = [](const char* name, double value, double most) {
    if (value >= 0.0 && value <= most) return;
    throw Error(ErrorCode::kBadInput, std::string(name) + " of " + std::to_string(value) + ": must be within 0.." +
                                          std::to_string(static_cast<int>(most)) + ", 0 for none");
  };
  check("limit of the broad curve", tests.broad_curve, 1.0);
  check("limit of the narrow curve", tests.narrow_curve, 1.0);
  check("limit of the second peak", tests.second_peak, 1.0);
  if (tests.second_peak > 0.0 && tests.second_peak < kLeastSecondPeak) {
    throw Error(ErrorCode::kBadInput, "limit of the second peak of " + std::to_string(tests.second_peak) +
                                          ": must be 0 for none or within 0.5..1; below that the valley before it "
                                          "is lost in noise, and fewer are found");
  }
  check("clipped share of a window", tests.clipped_share, 1.0);
  check("jump beside which a strip is dropped, in slices,", tests.edge_band_slices, kMaxEdgeBandSlices);
  check("largest sigma in um", tests.max_sigma_um, kMaxSigmaLimit_um);
}

}  // namespace

void check_focus_settings(const FocusSettings& settings) {
  const bool point = has_point_window(settings.focus_operator) && settings.window_px == 1;
  if (!point &&
      (settings.window_px < kMinWindowPx || settings.window_px > kMaxWindowPx || settings.window_px % 2 == 0)) {
    throw Error(ErrorCode::kBadInput, "window of " + std::to_string(settings.window_px) +
                                          " px: must be odd and within 3..63 px, or 1 px for the intensity");
  }
  if (settings.bin_slices < 1 || settings.bin_slices > kMaxBinSlices) {
    throw Error(ErrorCode::kBadInput,
                "bins of " + std::to_string(settings.bin_slices) + " slices: must be within 1..64 slices");
  }
  if (!(settings.min_significance >= 0.0 && settings.min_significance <= 1e6)) {
    throw Error(ErrorCode::kBadInput,
                "minimum significance of " + std::to_string(settings.min_significance) + ": must be within 0..1e6");
  }
  if (settings.distance_px < 1 || settings.distance_px > kMaxDistancePx) {
    throw Error(ErrorCode::kBadInput,
                "neighbour distance of " + std::to_string(settings.distance_px) + " px: must be within 1..7 px");
  }
  check_point_tests(settings.tests);
  if (!(settings.min_prominence >= 0.0 && settings.min_prominence <= 1.0)) {
    throw Error(ErrorCode::kBadInput,
                "minimum prominence of " + std::to_string(settings.min_prominence) + ": must be within 0..1");
  }
}

}  // namespace fvd
