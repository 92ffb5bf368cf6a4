#include "core/metrology/step/groove_layout.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include "core/base/error.hpp"
#include "core/metrology/step/step_parts.hpp"

namespace fvd::metrology {
namespace {

constexpr int kLeastTraces = 5;  // ISO 5436-1:2000, 7.1
constexpr double kOnBorder = 1e-9;

void check(const GrooveSettings& settings) {
  const auto refuse_empty = [](bool empty, const char* what) {
    if (empty) throw Error(ErrorCode::kBadInput, std::string(what) + " must reach from a smaller to a larger position");
  };
  if (settings.traces < kLeastTraces) {
    throw Error(ErrorCode::kBadInput,
                "a groove takes at least five traces, not " + std::to_string(settings.traces) + " (ISO 5436-1)");
  }
  refuse_empty(settings.band.has_value() && !(settings.band->from_um < settings.band->to_um), "the band of traces");
  refuse_empty(settings.search.has_value() && !(settings.search->from_um < settings.search->to_um),
               "the range in which edges are looked for");
  refuse_empty(settings.edges.has_value() && !(settings.edges->left_um < settings.edges->right_um),
               "the edges of a groove");
  if (settings.trace_width_um.has_value() && !(*settings.trace_width_um > 0.0)) {
    throw Error(ErrorCode::kBadInput, "a trace must be wider than 0 um");
  }
}

/// The field as the traces see it.
struct Extent {
  int length = 0;  // points in a trace
  int rows = 0;
  double pitch_um = 0.0;
  double row_pitch_um = 0.0;
};

Extent extent_of(const HeightField& field, Across across) {
  if (across == Across::kX) return {field.width(), field.height(), field.pitch_x_um, field.pitch_y_um};
  return {field.height(), field.width(), field.pitch_y_um, field.pitch_x_um};
}

IndexRange clamped(IndexRange range, int size) {
  return {std::clamp(range.first, 0, size), std::clamp(range.last, -1, size - 1)};
}

StepRefusal outside(const std::string& what, FromTo range, double end_um) {
  return {StepRefusalCode::kOutside,
          what + " reaches from " + figure_text(range.from_um) + " to " + figure_text(range.to_um) +
              " um, and the surface from 0 to " + figure_text(end_um) + " um",
          std::nullopt};
}

bool lies_within(FromTo range, double end_um, double pitch_um) {
  return range.from_um >= -kOnBorder * pitch_um && range.to_um <= end_um + kOnBorder * pitch_um;
}

/// Strips of equal width; one narrower than its share lies in its middle, and has at least the row there.
std::vector<GrooveStrip> strips_of(const GrooveSettings& settings, FromTo band, const Extent& extent) {
  const double share = (band.to_um - band.from_um) / settings.traces;
  const double width = std::min(share, settings.trace_width_um.value_or(share));
  std::vector<GrooveStrip> strips;
  for (int i = 0; i < settings.traces; ++i) {
    const double centre = band.from_um + (i + 0.5) * share;
    GrooveStrip strip{centre - 0.5 * width, centre + 0.5 * width, {}};
    strip.rows = centres_within({strip.from_um, strip.to_um}, extent.row_pitch_um);
    if (strip.rows.count() == 0) {
      const int row = static_cast<int>(centre / extent.row_pitch_um);
      strip.rows = {row, row};
    }
    strip.rows = clamped(strip.rows, extent.rows);
    strips.push_back(strip);
  }
  return strips;
}

StepOutcome<GrooveEdges> edges_of(const HeightField& field, const GrooveSettings& settings, const GrooveStrip& band,
                                  const Extent& extent) {
  if (settings.edges.has_value()) return *settings.edges;
  std::vector<double> trace = median_trace(field, settings.across, band.rows.first, band.rows.last);
  IndexRange searched{0, extent.length - 1};
  if (settings.search.has_value()) {
    searched = clamped(centres_within(*settings.search, extent.pitch_um), extent.length);
    if (searched.count() == 0)
      return outside("the search for edges", *settings.search, extent.length * extent.pitch_um);
    trace = std::vector<double>(trace.begin() + searched.first, trace.begin() + searched.last + 1);
  }
  const int lag = std::max(1, static_cast<int>(std::lround(field.kernel.width_px())));
  StepOutcome<GrooveEdges> found = find_groove_edges(trace, extent.pitch_um, lag);
  if (auto* edges = std::get_if<GrooveEdges>(&found)) {
    edges->left_um += searched.first * extent.pitch_um;
    edges->right_um += searched.first * extent.pitch_um;
  }
  return found;
}

}  // namespace

IndexRange centres_within(FromTo range, double pitch_um) {
  return {static_cast<int>(std::ceil(range.from_um / pitch_um - 0.5 - kOnBorder)),
          static_cast<int>(std::floor(range.to_um / pitch_um - 0.5 + kOnBorder))};
}

StepOutcome<GrooveLayout> lay_out_groove(const HeightField& field, const GrooveSettings& settings) {
  check(settings);
  const Extent extent = extent_of(field, settings.across);
  const double across_um = extent.rows * extent.row_pitch_um;
  const FromTo band = settings.band.value_or(FromTo{0.0, across_um});
  if (!lies_within(band, across_um, extent.row_pitch_um)) return outside("the band of traces", band, across_um);

  GrooveLayout layout;
  layout.across = settings.across;
  layout.band = {band.from_um, band.to_um, clamped(centres_within(band, extent.row_pitch_um), extent.rows)};
  const int rows = layout.band.rows.count();
  if (rows < settings.traces) {
    return StepRefusal{
        StepRefusalCode::kTooFewTraces,
        "the band has " + std::to_string(rows) + " rows, too few for " + std::to_string(settings.traces) + " traces",
        static_cast<double>(rows)};
  }
  layout.strips = strips_of(settings, band, extent);
  StepOutcome<GrooveEdges> edges = edges_of(field, settings, layout.band, extent);
  if (auto* refusal = std::get_if<StepRefusal>(&edges)) return std::move(*refusal);
  layout.edges = std::get<GrooveEdges>(edges);
  layout.edges_given = settings.edges.has_value();

  const std::array<FromTo, 3> regions = groove_regions(layout.edges);
  const double along_um = extent.length * extent.pitch_um;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    layout.along[i] = centres_within(regions[i], extent.pitch_um);
    const int asked = layout.along[i].count();
    const int inside = clamped(layout.along[i], extent.length).count();
    if (asked > 0 && (inside == 0 || inside < settings.min_valid_fraction * asked)) {
      return outside("region " + std::string(1, "ABC"[i]) + " of the groove", regions[i], along_um);
    }
  }
  return layout;
}

std::array<StepRegion, 3> count_regions(const HeightField& field, const GrooveLayout& layout,
                                        const GrooveStrip& strip) {
  std::array<StepRegion, 3> regions;
  const int length = extent_of(field, layout.across).length;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    StepRegion& region = regions[i];
    region.name = "ABC"[i];
    region.asked = layout.along[i].count() * strip.rows.count();
    const IndexRange along = clamped(layout.along[i], length);
    const bool along_x = layout.across == Across::kX;
    const IndexRange& columns = along_x ? along : strip.rows;
    const IndexRange& rows = along_x ? strip.rows : along;
    double sum = 0.0;
    for (int row = rows.first; row <= rows.last; ++row) {
      const double* z = field.z_um.row(row);
      for (int column = columns.first; column <= columns.last; ++column) {
        const bool is_hole = std::isnan(z[column]);
        sum += is_hole ? 0.0 : z[column];
        region.points += is_hole ? 0 : 1;
      }
    }
    if (region.points > 0) region.mean_z_um = sum / region.points;
  }
  return regions;
}

PointGroups groove_groups(const HeightField& field, const GrooveLayout& layout, const GrooveStrip& strip) {
  const int length = extent_of(field, layout.across).length;
  const int from = clamped(layout.along[0], length).first;
  const int to = clamped(layout.along[1], length).last;
  const bool along_x = layout.across == Across::kX;
  PointGroups groups;
  groups.left = along_x ? from : strip.rows.first;
  groups.top = along_x ? strip.rows.first : from;
  groups.count = 2;
  const int points = to - from + 1;
  groups.group =
      along_x ? Plane<std::uint8_t>(points, strip.rows.count()) : Plane<std::uint8_t>(strip.rows.count(), points);
  for (std::size_t i = 0; i < layout.along.size(); ++i) {
    const IndexRange along = clamped(layout.along[i], length);
    const auto group = static_cast<std::uint8_t>(i == 2 ? kBottom : kShoulders);
    const int first = along.first - from;
    if (along_x) {
      for (int row = 0; row < strip.rows.count(); ++row) {
        std::fill_n(groups.group.row(row) + first, along.count(), group);
      }
    } else {
      std::fill_n(groups.group.row(first), along.count() * strip.rows.count(), group);
    }
  }
  return groups;
}

WeightMap empty_weights(const HeightField& field, const GrooveLayout& layout) {
  const PointGroups groups = groove_groups(field, layout, layout.band);
  return {groups.left, groups.top, Plane<double>(groups.group.width(), groups.group.height())};
}

}  // namespace fvd::metrology
