#include "core/metrology/filter/surface_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.hpp"
#include "core/metrology/filter/border_error.hpp"
#include "core/metrology/filter/check_nesting.hpp"
#include "core/metrology/filter/robust_rounds.hpp"
#include "core/metrology/filter/smooth_noise.hpp"
#include "core/metrology/filter/surface_smoother.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

double mean_of_valid(std::span<const double> z_um) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double z : z_um) {
    if (std::isnan(z)) continue;
    sum += z;
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

/// The heights less their mean (sums of small numbers round less), 0 in holes; where they are valid; both again with
/// holes.
struct Centred {
  double mean_um = 0.0;
  Plane<double> z_um;
  Plane<double> with_holes_um;
  Plane<double> weights;
};

Centred centre(const Plane<double>& z_um) {
  Centred centred{mean_of_valid(z_um.pixels()), Plane<double>(z_um.width(), z_um.height()), z_um.clone(),
                  Plane<double>(z_um.width(), z_um.height())};
  const auto from = z_um.pixels();
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (std::isnan(from[i])) continue;
    const double z = from[i] - centred.mean_um;
    centred.z_um.pixels()[i] = z;
    centred.with_holes_um.pixels()[i] = z;
    centred.weights.pixels()[i] = 1.0;
  }
  return centred;
}

bool in_margin(const HeightField& field, int column, int row, double margin_um) {
  const double x = field.x_um(column);
  const double y = field.y_um(row);
  return x < margin_um || y < margin_um || x > field.width() * field.pitch_x_um - margin_um ||
         y > field.height() * field.pitch_y_um - margin_um;
}

/// Writes the side that was asked for; returns the smallest share beside a point that is given.
double write_side(const HeightField& field, const FilterSettings& settings, const Centred& centred,
                  const Plane<double>& smooth_um, const Plane<double>& share, HeightField& result,
                  FilterReport& report) {
  const double least = settings.method == FilterMethod::kGaussian ? kMinWeightShare : kMinRegressionWeightShare;
  double smallest = 1.0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      double& z = result.z_um.at(x, y);
      z = kHole;
      if (field.is_hole(x, y)) continue;
      ++report.points_in;
      // Rounding must not decide where exactly half is valid.
      const bool given = share.at(x, y) >= least - 1e-9 && !std::isnan(smooth_um.at(x, y)) &&
                         !in_margin(field, x, y, report.margin_um);
      if (!given) {
        ++report.points_lost;
        continue;
      }
      smallest = std::min(smallest, share.at(x, y));
      z = settings.side == FilterSide::kS ? smooth_um.at(x, y) + centred.mean_um
                                          : centred.z_um.at(x, y) - smooth_um.at(x, y);
    }
  }
  return smallest;
}

std::optional<double> median_sigma_um(const HeightField& field) {
  std::vector<float> values;
  for (const float sigma : field.sigma_um.pixels()) {
    if (!std::isnan(sigma)) values.push_back(sigma);
  }
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

void judge_border(const HeightField& field, const FilterSettings& settings, double smallest_share,
                  FilterReport& report) {
  const GeneralShape shape = general_shape(field.z_um, field.pitch_x_um, field.pitch_y_um);
  report.border_error_um = border_error_um(settings.method, settings.nesting_um, shape, smallest_share);
  report.noise_floor_um = settings.noise_floor_um ? settings.noise_floor_um : median_sigma_um(field);
  report.border_error_above_noise = report.noise_floor_um && report.border_error_um > *report.noise_floor_um;
}

}  // namespace

FilteredSurface filter_surface(const HeightField& field, const FilterSettings& settings, WorkerPool* pool) {
  if (field.z_um.empty()) throw Error(ErrorCode::kBadInput, "a filter needs a surface with at least one point");
  FilterReport report;
  report.nesting_px_x = checked_nesting_px(settings.nesting_um, field.pitch_x_um, " in x");
  report.nesting_px_y = checked_nesting_px(settings.nesting_um, field.pitch_y_um, " in y");
  const bool takes_margin =
      settings.side == FilterSide::kL && settings.method == FilterMethod::kGaussian && !settings.keep_margin;
  report.margin_um = takes_margin ? 0.5 * settings.nesting_um : 0.0;

  Centred centred = centre(field.z_um);
  Plane<double> smooth_um(field.width(), field.height());
  Plane<double> share(field.width(), field.height());
  Plane<double> share_of_points;
  const SmootherInput input{centred.z_um, centred.weights, settings.method, report.nesting_px_x, report.nesting_px_y};
  const auto fit = [&] {
    smooth_surface(input, pool, smooth_um, share);
    if (share_of_points.empty()) share_of_points = share.clone();  // the first fit's weights are the points
  };
  if (settings.robust) {
    const RobustRounds rounds =
        fit_robustly(centred.with_holes_um.pixels(), centred.weights.pixels(), smooth_um.pixels(), fit);
    report.rounds = rounds.rounds;
    report.converged = rounds.converged;
    report.cut_um = rounds.cut_um;
  } else {
    fit();
  }

  HeightField result{
      Plane<double>::unset(field.width(), field.height()), {}, field.pitch_x_um, field.pitch_y_um, field.kernel};
  const double smallest = write_side(field, settings, centred, smooth_um, share_of_points, result, report);
  judge_border(field, settings, smallest, report);
  carry_noise(field, settings, share_of_points, pool, result);
  return {std::move(result), report};
}

}  // namespace fvd::metrology
