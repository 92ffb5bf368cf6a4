#pragma once

/// The material ratio curve of a profile: its core, peaks and valleys.

#include <span>

namespace fvd::metrology {

/// ISO 21920-2:2021 (before: ISO 13565-2), heights in um, ratios in percent.
struct MaterialRatioCore {
  double core_um = 0.0;        ///< Rk
  double peaks_um = 0.0;       ///< Rpk
  double valleys_um = 0.0;     ///< Rvk
  double upper_percent = 0.0;  ///< Rmr1
  double lower_percent = 0.0;  ///< Rmr2
  bool tie = false;            ///< another secant of 40 % is as flat; the first from the left was taken
};

/// sorted_um: highest first, at least 3, none NaN. The curve goes straight through the heights at the ratios
/// (i + 0.5) / n. Secants see it go on straight beyond the first and last, areas and ratios level. The flattest secant
/// over 40 % of ratio, the first from the left (equal to 1e-9 of the height), makes the core; areas outside are exact.
/// context: pure.
[[nodiscard]] MaterialRatioCore material_ratio_core(std::span<const double> sorted_um);

}  // namespace fvd::metrology
