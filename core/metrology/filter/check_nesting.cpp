#include "core/metrology/filter/check_nesting.hpp"

#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/error.hpp"
#include "core/metrology/filter/filter_settings.hpp"

namespace fvd::metrology {
namespace {

constexpr double kMostNestingPx = 1e6;

std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

double checked_nesting_px(double nesting_um, double pitch_um, std::string_view axis) {
  const double nesting_px = nesting_um / pitch_um;
  if (!std::isfinite(nesting_um) || !(nesting_um > 0.0) || !std::isfinite(pitch_um) || !(pitch_um > 0.0)) {
    throw Error(ErrorCode::kBadInput, "nesting index " + figure(nesting_um) + " um and pitch " + figure(pitch_um) +
                                          " um" + std::string(axis) + " must be positive numbers");
  }
  if (!(nesting_px >= kMinNestingPx * (1.0 - 1e-9))) {  // 0.35 / 0.07 is below 5
    throw Error(ErrorCode::kBadInput, "nesting index " + figure(nesting_um) + " um is " + figure(nesting_px) +
                                          " pixels" + std::string(axis) + "; a filter needs at least " +
                                          figure(kMinNestingPx) + " pixels, here " + figure(kMinNestingPx * pitch_um) +
                                          " um");
  }
  if (nesting_px > kMostNestingPx) {
    throw Error(ErrorCode::kBadInput, "nesting index " + figure(nesting_um) + " um is " + figure(nesting_px) +
                                          " pixels" + std::string(axis) + "; at most " + figure(kMostNestingPx));
  }
  return nesting_px;
}

}  // namespace fvd::metrology
