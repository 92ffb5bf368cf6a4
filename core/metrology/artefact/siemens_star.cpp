#include "core/metrology/artefact/siemens_star.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Dense>

#include "core/base/error.hpp"
#include "core/metrology/artefact/star_centre.hpp"
#include "core/metrology/artefact/two_levels.hpp"

namespace fvd::metrology {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFullWave = 2.0 / kPi;     ///< amplitude of the wave in sectors of heights 0 and 1
constexpr double kMiddle = 0.94;            ///< cosine of 20 degrees of the wave's phase: the middle of a sector
constexpr double kShortestPeriod_px = 3.0;  ///< below it a ring has too few points a period
constexpr double kHalfRing_px = 1.5;
constexpr double kRingStep_px = 0.5;
constexpr int kFewestPoints = 10;
constexpr int kFewestInMiddle = 3;
constexpr double kLongestGap_px = 4.0;      ///< between rings that a fall below one half is interpolated between
constexpr double kMostHeightChange = 0.05;  ///< near the rim, of a height that is reached there

/// A point in polar coordinates, its height over the lower level in steps.
struct StarPoint {
  double radius_um = 0.0;
  double phase = 0.0;  ///< of the star's wave
  double share = 0.0;
};

/// The points of one direction, from the rim inwards.
using Sector = std::vector<StarPoint>;

std::vector<Sector> sectors_of(const HeightField& field, const Region& region, const TwoLevels& levels,
                               const StarLayout& star, int directions) {
  std::vector<Sector> sectors(static_cast<std::size_t>(directions));
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      const double z = field.z_um.at(x, y);
      if (std::isnan(z) || !is_inside(region, x, y)) continue;
      const double dx = field.x_um(x) - star.centre.x;
      const double dy = field.y_um(y) - star.centre.y;
      const double radius = std::hypot(dx, dy);
      if (radius > star.radius_um) continue;
      const double azimuth = std::atan2(dy, dx);
      const auto number = std::lround(azimuth / (2.0 * kPi) * directions) + directions;
      sectors[static_cast<std::size_t>(number % directions)].push_back(
          {radius, star.pairs * azimuth - star.phase, levels.share(x, y, z)});
    }
  }
  for (Sector& sector : sectors) {
    std::sort(sector.begin(), sector.end(),
              [](const StarPoint& a, const StarPoint& b) { return a.radius_um > b.radius_um; });
  }
  return sectors;
}

/// Responses of a ring, in steps of the two levels: 1 where the whole height is there.
struct Ring {
  double radius_um = 0.0;
  std::optional<double> middle;  ///< of the sectors' middles against those of the gaps
  std::optional<double> wave;    ///< of the wave's amplitude
};

Ring ring_of(Sector::const_iterator first, Sector::const_iterator end) {
  Ring ring;
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double sums[2] = {0.0, 0.0};
  int counts[2] = {0, 0};
  for (auto point = first; point != end; ++point) {
    ring.radius_um += point->radius_um / static_cast<double>(end - first);
    const Eigen::Vector3d terms(1.0, std::cos(point->phase), std::sin(point->phase));
    matrix += terms * terms.transpose();
    vector += terms * point->share;
    if (std::abs(terms[1]) < kMiddle) continue;
    const int gap = terms[1] < 0.0 ? 1 : 0;
    sums[gap] += point->share;
    ++counts[gap];
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  if (end - first >= kFewestPoints && solver.info() == Eigen::Success && solver.rcond() > 1e-3) {
    ring.wave = solver.solve(vector)[1] / kFullWave;
  }
  if (counts[0] >= kFewestInMiddle && counts[1] >= kFewestInMiddle) {
    ring.middle = sums[0] / counts[0] - sums[1] / counts[1];
  }
  return ring;
}

/// From the rim inwards.
std::vector<Ring> rings_of(const Sector& sector, double pitch_um, double inner_um) {
  std::vector<Ring> rings;
  if (sector.empty()) return rings;
  const double half_um = kHalfRing_px * pitch_um;
  auto first = sector.begin();
  auto end = sector.begin();
  for (double at = sector.front().radius_um - half_um; at >= inner_um; at -= kRingStep_px * pitch_um) {
    while (first != sector.end() && first->radius_um > at + half_um) ++first;
    end = std::max(end, first);
    while (end != sector.end() && end->radius_um >= at - half_um) ++end;
    if (first != end) rings.push_back(ring_of(first, end));
  }
  return rings;
}

/// Radius where the response first falls below one half of the height; else why there is none.
struct Fall {
  std::optional<double> radius_um;
  std::string reason;
};

Fall half_height(const std::vector<Ring>& rings, std::optional<double> Ring::*response, double height,
                 double pitch_um) {
  const Ring* before = nullptr;
  for (const Ring& ring : rings) {
    if (!(ring.*response)) continue;
    const double here = *(ring.*response) / height;
    if (here >= 0.5) {
      before = &ring;
      continue;
    }
    if (before == nullptr) return {{}, "half of the height is not reached at the farthest ring"};
    const double there = *(before->*response) / height;
    if (before->radius_um - ring.radius_um > kLongestGap_px * pitch_um) return {{}, "holes where the height falls"};
    return {ring.radius_um + (before->radius_um - ring.radius_um) * (0.5 - here) / (there - here), {}};
  }
  if (before == nullptr) return {{}, "too few points"};
  return {{}, "resolved as far inwards as pixels or points tell"};
}

/// Mean middle response of all directions between two shares of the radius; absent where no ring has one.
std::optional<double> mean_height(const std::vector<std::vector<Ring>>& all, double radius_um, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (const std::vector<Ring>& rings : all) {
    for (const Ring& ring : rings) {
      if (!ring.middle || ring.radius_um < from * radius_um || ring.radius_um > to * radius_um) continue;
      sum += *ring.middle;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void check(const HeightField& field, const StarSettings& settings) {
  const auto refuse = [](const char* text) { throw Error(ErrorCode::kBadInput, text); };
  if (settings.pairs && (*settings.pairs < 4 || *settings.pairs > 180)) refuse("a star has 4 to 180 pairs of sectors");
  if (settings.directions < 4 || settings.directions > 36) refuse("a star is seen in 4 to 36 directions");
  // Rings are counted from the centre: one that is far off would need memory for all between.
  const auto within = [](double place_um, double end_um) { return place_um >= 0.0 && place_um <= end_um; };
  const bool inside = !settings.centre || (within(settings.centre->x, field.width() * field.pitch_x_um) &&
                                           within(settings.centre->y, field.height() * field.pitch_y_um));
  if (!inside) refuse("the centre of a star is a place in the field");
  if (settings.height_um && !(*settings.height_um > 0.0 && std::isfinite(*settings.height_um))) {
    refuse("the height of a star is above 0");
  }
}

StarDirection direction_of(const std::vector<Ring>& rings, const StarLayout& star, double height, double pitch_um) {
  StarDirection direction;
  const Fall width = half_height(rings, &Ring::middle, height, pitch_um);
  const Fall period = half_height(rings, &Ring::wave, height, pitch_um);
  if (width.radius_um) direction.width_um = *width.radius_um * kPi / star.pairs;
  if (period.radius_um) direction.period_um = *period.radius_um * 2.0 * kPi / star.pairs;
  direction.reason = width.reason.empty() ? period.reason : width.reason;
  return direction;
}

}  // namespace

StudyOutcome<StarResolution> siemens_star(const HeightField& field, const StarSettings& settings,
                                          const Region& region) {
  check(field, settings);
  const StudyOutcome<TwoLevels> levels_or = two_levels(field, region, Between::kAny);  // a fine star is mostly edges
  if (const auto* refusal = std::get_if<StudyRefusal>(&levels_or)) return *refusal;
  const TwoLevels& levels = std::get<TwoLevels>(levels_or);
  const auto star = find_star(field, level_shares(field, region, levels), {settings.pairs, settings.centre});
  if (!star) return StudyRefusal{"the heights have no star: no sectors that follow each other around a centre"};
  if (star->pairs < settings.directions) {
    return StudyRefusal{"a star of " + std::to_string(star->pairs) + " pairs of sectors cannot tell " +
                        std::to_string(settings.directions) + " directions"};
  }
  const double pitch_um = std::max(field.pitch_x_um, field.pitch_y_um);
  const double inner_um = kShortestPeriod_px * pitch_um * star->pairs / (2.0 * kPi);
  std::vector<std::vector<Ring>> rings;
  for (const Sector& sector : sectors_of(field, region, levels, *star, settings.directions)) {
    rings.push_back(rings_of(sector, pitch_um, inner_um));
  }
  const std::optional<double> at_rim = mean_height(rings, star->radius_um, 0.75, 0.9);
  const std::optional<double> inside = mean_height(rings, star->radius_um, 0.6, 0.75);
  if (!at_rim || !inside) return StudyRefusal{"the star has too few points near its rim"};
  if (!settings.height_um && std::abs(*at_rim - *inside) > kMostHeightChange * *at_rim) {
    return StudyRefusal{"the star's height still falls near its rim: its true height has to be given"};
  }

  StarResolution result{star->centre,
                        star->pairs,
                        star->radius_um,
                        settings.height_um.value_or(*at_rim * levels.step_um),
                        settings.height_um.has_value(),
                        0.0,
                        0.0,
                        {}};
  std::vector<double> widths;
  std::vector<double> periods;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    StarDirection direction = direction_of(rings[i], *star, result.height_um / levels.step_um, pitch_um);
    direction.azimuth_deg = 360.0 * static_cast<double>(i) / settings.directions;
    direction.across_deg = std::fmod(direction.azimuth_deg + 90.0, 180.0);
    if (direction.width_um) widths.push_back(*direction.width_um);
    if (direction.period_um) periods.push_back(*direction.period_um);
    result.directions.push_back(std::move(direction));
  }
  const std::size_t half = (rings.size() + 1) / 2;
  if (widths.size() < half || periods.size() < half) {
    std::string text = "the star shows where its height falls in " +
                       std::to_string(std::min(widths.size(), periods.size())) + " of " + std::to_string(rings.size()) +
                       " directions only";
    for (const StarDirection& direction : result.directions) {
      if (direction.reason.empty()) continue;
      text += ": " + direction.reason;
      break;
    }
    return StudyRefusal{text};
  }
  result.width_um = *median(std::move(widths));
  result.period_um = *median(std::move(periods));
  return result;
}

}  // namespace fvd::metrology
