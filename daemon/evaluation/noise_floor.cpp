#include "daemon/evaluation/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "core/metrology/region_bounds.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

constexpr double kAboveFloor = 2.0;

}  // namespace

ordered_json number_or_null(std::optional<double> value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

NoiseFloor noise_floor(const metrology::HeightField& field, const metrology::Region& region) {
  if (!field.has_sigma()) return {};
  const metrology::RegionBounds bounds = metrology::bounds_of(region, field.width(), field.height());
  double squares = 0.0;
  double points = 0.0;
  for (int row = bounds.top; row < bounds.bottom; ++row) {
    const double* z = field.z_um.row(row);
    const float* sigma_um = field.sigma_um.row(row);
    const std::uint8_t* inside = region.empty() ? nullptr : region.row(row);
    for (int column = bounds.left; column < bounds.right; ++column) {
      if (std::isnan(z[column]) || (inside != nullptr && inside[column] == 0)) continue;
      const auto here_um = static_cast<double>(sigma_um[column]);
      squares += here_um * here_um;
      points += 1.0;
    }
  }
  if (points == 0.0) return {};
  return {std::sqrt(squares / points)};
}

bool is_below_noise(std::optional<double> sq_um, const NoiseFloor& floor) noexcept {
  return sq_um && floor.sq_um && *sq_um < kAboveFloor * *floor.sq_um;
}

ordered_json texture_conditions(const MeasurementInput& input, const NoiseFloor& floor) {
  const metrology::HeightField& field = input.surface.field;
  const double s_um = std::max(input.surface.s_nesting_um.value_or(0.0), input.lateral_period_um);
  const double window_um = input.measured.field.kernel.width_px() * field.pitch_x_um;
  return {{"noise_floor_Sq_um", number_or_null(floor.sq_um)},
          {"window_um", knows_window(input.measured.field) ? ordered_json(window_um) : ordered_json(nullptr)},
          {"S_um", number_or_null(input.surface.s_nesting_um)},
          {"L_um", number_or_null(input.surface.l_nesting_um)},
          {"S_effective_um", s_um > 0.0 ? ordered_json(s_um) : ordered_json(nullptr)}};
}

void warn_below_noise(double sq_um, const NoiseFloor& floor, EvaluatedMeasurement& made) {
  std::ostringstream text;
  text.precision(3);
  text << "the root mean square of " << sq_um << " um is below twice the noise of " << *floor.sq_um
       << " um: most of the texture is the instrument's own";
  made.warnings.push_back({"below_noise", text.str()});
}

std::vector<std::string> texture_not_evaluated(const MeasurementInput& input) {
  std::vector<std::string> sources{"window_transfer"};
  if (!input.surface.field.has_sigma()) sources.emplace_back("noise");
  if (input.surface.robust) sources.emplace_back("robust_steps");
  if (input.context.samples.empty()) sources.emplace_back("slice_z");
  return sources;
}

std::string too_few_valid(double valid_fraction, const PlannedMeasurement& planned) {
  if (valid_fraction >= planned.min_valid_fraction) return {};
  std::ostringstream text;
  text.precision(3);
  text << "only " << 100.0 * valid_fraction << " % of the points are valid; the recipe asks for "
       << 100.0 * planned.min_valid_fraction << " %";
  return text.str();
}

}  // namespace fvd
