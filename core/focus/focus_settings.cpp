#include "core/focus/focus_settings.hpp"

#include <string>

#include "core/error.hpp"

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
  }
  return "nearest";
}

std::optional<PeakMethod> peak_method_from_name(std::string_view name) noexcept {
  for (const PeakMethod method : kAllPeakMethods) {
    if (name == peak_method_name(method)) return method;
  }
  return std::nullopt;
}

void check_focus_settings(const FocusSettings& settings) {
  if (settings.window_px < kMinWindowPx || settings.window_px > kMaxWindowPx || settings.window_px % 2 == 0) {
    throw Error(ErrorCode::kBadInput,
                "window of " + std::to_string(settings.window_px) + " px: must be odd and within 3..63 px");
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
