#pragma once

/// Lateral resolution from a Siemens star: sectors of equal angle, raised and not in turn.

#include <optional>
#include <string>
#include <vector>

#include "core/metrology/height_field.hpp"
#include "core/metrology/operations/region.hpp"
#include "core/metrology/study/noise_study.hpp"

namespace fvd::metrology {

struct StarSettings {
  std::optional<int> pairs{};         ///< of a raised sector and one that is not, 4 to 180; absent: found
  std::optional<PointUm> centre{};    ///< in the field; absent: found
  std::optional<double> height_um{};  ///< true height of the raised ones; absent: as measured near the star's rim
  int directions = 8;                 ///< 4 to 36; the first is centred on 0 degrees
};

/// What is resolved in one direction. A value is absent where `reason` says why.
struct StarDirection {
  double azimuth_deg = 0.0;  ///< where from the centre, from x towards y, 0 <= a < 360
  double across_deg = 0.0;   ///< direction in which the sectors follow each other there, 0 <= a < 180
  std::optional<double> width_um;
  std::optional<double> period_um;
  std::string reason;
};

struct StarResolution {
  PointUm centre;
  int pairs = 0;
  double radius_um = 0.0;  ///< of the star, as far as it lies in the field
  double height_um = 0.0;  ///< true height that was used
  bool height_given = false;
  double width_um = 0.0;   ///< W_R, median of the directions that have one
  double period_um = 0.0;  ///< D_LIM, likewise
  std::vector<StarDirection> directions;
};

/// width_um, W_R: width of a raised sector where its middle stands half of the true height above the middles of its
/// neighbours. period_um, lateral period limit D_LIM of ISO 25178-600:2019: period of the star where the part of the
/// heights that is sinusoidal in the angle has half of the amplitude that it has in the true star, which is the
/// response to a sinusoid of that period. Both by rings from the rim inwards: the first fall below one half counts.
/// A box of side w reads W_R = 0.75 w and D_LIM = 1.657 w along its sides.
/// Refused: no two levels, no star, a height that is not reached near the rim, under half of the directions with a
/// value. Throws Error(kBadInput) for settings out of range. context: pure.
[[nodiscard]] StudyOutcome<StarResolution> siemens_star(const HeightField& field, const StarSettings& settings = {},
                                                        const Region& region = {});

}  // namespace fvd::metrology
