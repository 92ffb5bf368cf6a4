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

int choose_bin_slices(double step_um, double curve_width_um) noexcept {
  constexpr double kSampleDistance = 0.4;
  if (!(curve_width_um > 0.0) || !(std::abs(step_um) > 0.0)) return 1;
  const double slices = std::floor(kSampleDistance * curve_width_um / std::abs(step_um) + 0.25);
  return static_cast<int>(std::clamp(slices, 1.0, static_cast<double>(kMaxBinSlices)));
}

void check_focus_settings(const FocusSettings& settings) {
  const bool point = settings.focus_operator == FocusOperator::kIntensity && settings.window_px == 1;
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
  if (!(settings.min_prominence >= 0.0 && settings.min_prominence <= 1.0)) {
    throw Error(ErrorCode::kBadInput,
                "minimum prominence of " + std::to_string(settings.min_prominence) + ": must be within 0..1");
  }
}

}  // namespace fvd
