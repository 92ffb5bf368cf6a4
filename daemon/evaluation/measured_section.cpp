#include "daemon/evaluation/measured_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/metrology/region_bounds.hpp"

namespace fvd {

namespace {

struct Point {
  double x_um = 0.0;
  double y_um = 0.0;
};

Point centre_of(const metrology::HeightField& field, const metrology::Region& region) {
  const metrology::RegionBounds bounds = metrology::bounds_of(region, region.width(), region.height());
  double columns = 0.0;
  double rows = 0.0;
  double count = 0.0;
  for (int y = bounds.top; y < bounds.bottom; ++y) {
    const std::uint8_t* inside = region.row(y);
    std::int64_t in_row = 0;
    std::int64_t sum = 0;  // whole numbers: as exact as sums of halves
    for (int x = bounds.left; x < bounds.right; ++x) {
      in_row += inside[x] != 0 ? 1 : 0;
      sum += inside[x] != 0 ? x : 0;
    }
    columns += static_cast<double>(sum) + 0.5 * static_cast<double>(in_row);
    rows += (y + 0.5) * static_cast<double>(in_row);
    count += static_cast<double>(in_row);
  }
  return {columns / count * field.pitch_x_um, rows / count * field.pitch_y_um};
}

/// How far from `at` into the direction the field's border is.
double reach_um(const metrology::HeightField& field, const Point& at, double along_x, double along_y) {
  const auto to_border = [](double place, double direction, double length) {
    if (direction == 0.0) return std::numeric_limits<double>::infinity();
    return (direction > 0.0 ? length - place : -place) / direction;
  };
  return std::min(to_border(at.x_um, along_x, field.width() * field.pitch_x_um),
                  to_border(at.y_um, along_y, field.height() * field.pitch_y_um));
}

void add_region(const metrology::HeightField& field, const SectionRegion& region, CrossSection& section) {
  const double pitch_um = std::min(field.pitch_x_um, field.pitch_y_um);
  const double length_um = section.length_um();
  const int steps = std::max(1, static_cast<int>(length_um / pitch_um));
  std::optional<CrossSection::Region> found;
  for (int i = 0; i < steps; ++i) {
    const double share = (i + 0.5) / steps;
    const auto place = [share](double from, double to, double pitch, int count) {
      return std::clamp(static_cast<int>((from + share * (to - from)) / pitch), 0, count - 1);
    };
    const int x = place(section.from_x_um, section.to_x_um, field.pitch_x_um, field.width());
    const int y = place(section.from_y_um, section.to_y_um, field.pitch_y_um, field.height());
    if (region.points->at(x, y) == 0) continue;
    if (!found) found = CrossSection::Region{region.name, i * length_um / steps, 0.0};
    found->to_um = (i + 1) * length_um / steps;
  }
  if (found) section.regions.push_back(*found);
}

}  // namespace

CrossSection groove_section(const metrology::HeightField& field, const metrology::GrooveSettings& settings,
                            const metrology::GrooveEdges& edges) {
  const bool along_x = settings.across == metrology::Across::kX;
  const double width_um = field.width() * field.pitch_x_um;
  const double height_um = field.height() * field.pitch_y_um;
  const double length_um = along_x ? width_um : height_um;
  const double across_um = along_x ? height_um : width_um;
  const metrology::FromTo band = settings.band.value_or(metrology::FromTo{0.0, across_um});
  const double middle_um = (band.from_um + band.to_um) / 2.0;
  CrossSection section;
  section.from_x_um = along_x ? 0.0 : middle_um;
  section.from_y_um = along_x ? middle_um : 0.0;
  section.to_x_um = along_x ? length_um : middle_um;
  section.to_y_um = along_x ? middle_um : length_um;
  section.band_width_um = band.to_um - band.from_um;
  constexpr std::array kNames{"A", "B", "C"};
  const auto regions = metrology::groove_regions(edges);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    section.regions.push_back({kNames[i], regions[i].from_um, regions[i].to_um});
  }
  return section;
}

CrossSection regions_section(const metrology::HeightField& field, std::span<const SectionRegion> regions) {
  const Point first = centre_of(field, *regions.front().points);
  const Point last = centre_of(field, *regions.back().points);
  const double distance_um = std::hypot(last.x_um - first.x_um, last.y_um - first.y_um);
  // Regions around each other have one centre: a row is as good as any line then.
  const double along_x = distance_um > 0.0 ? (last.x_um - first.x_um) / distance_um : 1.0;
  const double along_y = distance_um > 0.0 ? (last.y_um - first.y_um) / distance_um : 0.0;
  const double before_um = reach_um(field, first, -along_x, -along_y);
  const double behind_um = reach_um(field, last, along_x, along_y);
  CrossSection section;
  section.from_x_um = first.x_um - along_x * before_um;
  section.from_y_um = first.y_um - along_y * before_um;
  section.to_x_um = last.x_um + along_x * behind_um;
  section.to_y_um = last.y_um + along_y * behind_um;
  section.band_width_um = std::min(field.pitch_x_um, field.pitch_y_um);
  for (const SectionRegion& region : regions) add_region(field, region, section);
  return section;
}

CrossSection profile_section(const PlannedMeasurement& planned) {
  CrossSection section;
  section.from_x_um = planned.from_um[0];
  section.from_y_um = planned.from_um[1];
  section.to_x_um = planned.to_um[0];
  section.to_y_um = planned.to_um[1];
  section.band_width_um = planned.band_width_um;
  return section;
}

std::optional<CrossSection> edge_section(const metrology::CuttingEdge& edge, const PlannedMeasurement& planned) {
  std::vector<const metrology::EdgeSection*> measured;
  for (const metrology::EdgeSection& section : edge.sections) {
    if (section.state == metrology::EdgeReason::kNone) measured.push_back(&section);
  }
  if (measured.empty()) return std::nullopt;
  const metrology::EdgeSection& middle = *measured[measured.size() / 2];
  const double angle = edge.direction_deg * std::numbers::pi / 180.0;
  const double from_um = planned.flank_um.at(0);
  const double to_um = planned.flank_um.at(1);
  constexpr double kBeyond = 1.3;
  const double half_um = kBeyond * to_um;
  CrossSection section;
  section.from_x_um = middle.x_um + std::sin(angle) * half_um;
  section.from_y_um = middle.y_um - std::cos(angle) * half_um;
  section.to_x_um = middle.x_um - std::sin(angle) * half_um;
  section.to_y_um = middle.y_um + std::cos(angle) * half_um;
  // Always from left to right: the flanks lie as in the image.
  if (section.from_x_um > section.to_x_um) {
    std::swap(section.from_x_um, section.to_x_um);
    std::swap(section.from_y_um, section.to_y_um);
  }
  section.band_width_um = planned.sections_every_um;
  section.regions = {{"flank", half_um - to_um, half_um - from_um}, {"flank", half_um + from_um, half_um + to_um}};
  return section;
}

}  // namespace fvd
