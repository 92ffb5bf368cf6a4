#pragma once

/// Nesting indices that a sampled kernel cannot serve.

#include <string_view>

namespace fvd::metrology {

/// The nesting index in pixels. Throws Error(kBadInput) with the figures where that is under kMinNestingPx or above
/// 1e6, or where a number is not positive. axis: e.g. " in x", may be empty.
double checked_nesting_px(double nesting_um, double pitch_um, std::string_view axis);

}  // namespace fvd::metrology
