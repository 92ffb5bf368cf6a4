#pragma once

/// Surfaces of two levels with one slope: where the levels lie, and every point's share of the way between them.

#include "core/metrology/height_field.hpp"
#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

/// Lower level: z = offset_um + rise_x_um * column + rise_y_um * row, in pixels from the centre of the first.
struct TwoLevels {
  double offset_um = 0.0;
  double rise_x_um = 0.0;
  double rise_y_um = 0.0;
  double step_um = 0.0;  ///< from the lower to the upper level, > 0

  [[nodiscard]] double share(double column, double row, double z_um) const {
    return (z_um - offset_um - rise_x_um * column - rise_y_um * row) / step_um;
  }
};

/// Whether heights half-way between the levels have to be rarer than those at each of them.
enum class Between { kRare, kAny };

/// The slope is that of the majority of near neighbours, the levels are separated after Otsu (1979) and fitted together
/// with one slope. Refused: under 1000 valid points, no levels apart, or too many heights between them. context: pure.
[[nodiscard]] StudyOutcome<TwoLevels> two_levels(const HeightField& field, const Region& region,
                                                 Between between = Between::kRare);

/// 0 on the lower level, 1 on the upper, from -0.5 to 1.5; NaN in holes and outside of the region.
[[nodiscard]] Plane<float> level_shares(const HeightField& field, const Region& region, const TwoLevels& levels);

}  // namespace fvd::metrology
