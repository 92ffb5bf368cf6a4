#include "core/metrology/step/groove_layout.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace fvd::metrology {

namespace {

constexpr int kLeastTraces = 5;

/// The indices whose centres lie within; `count` only bounds rows, since regions may reach beyond the field.
ColumnRange centres_within(const FromTo& range, double pitch_um) {
  return {static_cast<int>(std::ceil(range.from_um / pitch_um - 0.5)),
          static_cast<int>(std::floor(range.to_um / pitch_um - 0.5))};
}

void require(bool good, const std::string& what) {
  if (!good) throw Error(ErrorCode::kBadInput, what);
}

StepRefusal outside(const std::string& text) { return {StepRefusalCode::kOutside, text, std::nullopt}; }

std::vector<RowRange> strips_of(const RowRange& band, const GrooveSettings& settings, double pitch_um) {
  std::vector<RowRange> strips;
  for (int i = 0; i < settings.traces; ++i) {
    RowRange strip{band.first + i * band.rows() / settings.traces,
                   band.first + (i + 1) * band.rows() / settings.traces - 1};
    if (settings.trace_width_um) {
      const int wanted = std::max(1, static_cast<int>(std::lround(*settings.trace_width_um / pitch_um)));
      const int spare = std::max(0, strip.rows() - wanted);
      strip.first += spare / 2;
      strip.last -= spare - spare / 2;
    }
    strips.push_back(strip);
  }
  return strips;
}

StepOutcome<GrooveEdges> edges_of(const HeightField& field, const GrooveSettings& settings, const RowRange& band) {
  if (settings.edges) return *settings.edges;
  std::vector<double> trace = median_trace(field, Across::kX, band.first, band.last);
  double offset_um = 0.0;
  if (settings.search) {
    const ColumnRange asked = centres_within(*settings.search, field.pitch_x_um);
    const int first = std::max(asked.first, 0);
    const int last = std::min(asked.last, field.width() - 1);
    if (first > last) return outside("the range that edges are sought in does not lie in the field of view");
    trace = {trace.begin() + first, trace.begin() + last + 1};
    offset_um = first * field.pitch_x_um;
  }
  const int lag = std::max(1, static_cast<int>(std::lround(field.kernel.width_px())));
  auto outcome = find_groove_edges(trace, field.pitch_x_um, lag);
  if (auto* edges = std::get_if<GrooveEdges>(&outcome)) {
    edges->left_um += offset_um;
    edges->right_um += offset_um;
  }
  return outcome;
}

}  // namespace

StepOutcome<GrooveLayout> lay_out_groove(const HeightField& field, const GrooveSettings& settings) {
  require(settings.traces >= kLeastTraces,
          std::to_string(settings.traces) + " traces; ISO 5436-1 asks for five or more");
  require(!settings.band || settings.band->from_um < settings.band->to_um, "the band of the traces is empty");
  require(!settings.search || settings.search->from_um < settings.search->to_um, "the range of the edges is empty");
  require(!settings.edges || settings.edges->width_um() > 0.0, "the edges of the groove are not in order");
  GrooveLayout layout;
  layout.band = {0, field.height() - 1};
  if (settings.band) {
    const ColumnRange rows = centres_within(*settings.band, field.pitch_y_um);
    if (rows.first < 0 || rows.last >= field.height() || rows.first > rows.last) {
      return outside("the band of the traces does not lie in the field of view");
    }
    layout.band = {rows.first, rows.last};
  }
  if (layout.band.rows() < settings.traces) {
    std::ostringstream text;
    text << "the band has " << layout.band.rows() << " rows for " << settings.traces << " traces";
    return StepRefusal{StepRefusalCode::kTooFewTraces, text.str(), static_cast<double>(layout.band.rows())};
  }
  auto edges = edges_of(field, settings, layout.band);
  if (auto* refusal = std::get_if<StepRefusal>(&edges)) return *refusal;
  layout.edges = std::get<GrooveEdges>(edges);
  layout.edges_given = settings.edges.has_value();
  layout.strips = strips_of(layout.band, settings, field.pitch_y_um);
  const auto regions = groove_regions(layout.edges);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    layout.regions[i] = centres_within(regions[i], field.pitch_x_um);
    if (layout.regions[i].first > layout.regions[i].last) {
      return StepRefusal{StepRefusalCode::kNoEdges, "the groove is narrower than three points", std::nullopt};
    }
  }
  return layout;
}

PointGroups groove_groups(const HeightField& field, const GrooveLayout& layout, const RowRange& rows) {
  PointGroups groups;
  groups.count = 2;
  groups.left = std::clamp(layout.regions[0].first, 0, field.width());
  groups.top = rows.first;
  const int right = std::clamp(layout.regions[1].last, -1, field.width() - 1);
  groups.group = Plane<std::uint8_t>(std::max(right - groups.left + 1, 0), rows.rows(), 0);
  for (std::size_t i = 0; i < layout.regions.size(); ++i) {
    const int first = std::max(layout.regions[i].first, 0);
    const int last = std::min(layout.regions[i].last, field.width() - 1);
    const std::uint8_t group = i == 2 ? 2 : 1;
    for (int row = 0; row < rows.rows(); ++row) {
      for (int column = first; column <= last; ++column) groups.group.at(column - groups.left, row) = group;
    }
  }
  return groups;
}

std::array<StepRegion, 3> groove_counts(const HeightField& field, const GrooveLayout& layout, const RowRange& rows) {
  std::array<StepRegion, 3> counts{StepRegion{"A", 0, 0, 0.0}, StepRegion{"B", 0, 0, 0.0}, StepRegion{"C", 0, 0, 0.0}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const ColumnRange& range = layout.regions[i];
    counts[i].asked = (range.last - range.first + 1) * rows.rows();
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = std::max(range.first, 0); column <= std::min(range.last, field.width() - 1); ++column) {
        if (field.is_hole(column, row)) continue;
        ++counts[i].points;
        counts[i].mean_z_um += field.z_um.at(column, row);
      }
    }
    if (counts[i].points > 0) counts[i].mean_z_um /= counts[i].points;
  }
  return counts;
}

std::optional<StepRefusal> too_few_valid(const std::array<StepRegion, 3>& regions, double min_valid_fraction) {
  const auto& least = *std::min_element(regions.begin(), regions.end(), [](const StepRegion& a, const StepRegion& b) {
    return a.valid_fraction() < b.valid_fraction();
  });
  if (least.points > 0 && least.valid_fraction() >= min_valid_fraction) return std::nullopt;
  std::ostringstream text;
  text.precision(3);
  text << "of region " << least.name << " only " << 100.0 * least.valid_fraction() << " % of " << least.asked
       << " points are valid; " << 100.0 * min_valid_fraction << " % are asked for";
  return StepRefusal{StepRefusalCode::kTooFewValid, text.str(), least.valid_fraction()};
}

HeightField transposed(const HeightField& field) {
  const auto turned = [](const auto& plane) {
    using Element = std::remove_cvref_t<decltype(plane.at(0, 0))>;
    Plane<Element> made = Plane<Element>::unset(plane.height(), plane.width());
    for (int y = 0; y < plane.height(); ++y) {
      for (int x = 0; x < plane.width(); ++x) made.at(y, x) = plane.at(x, y);
    }
    return made;
  };
  HeightField made;
  made.z_um = turned(field.z_um);
  if (field.has_sigma()) made.sigma_um = turned(field.sigma_um);
  made.pitch_x_um = field.pitch_y_um;
  made.pitch_y_um = field.pitch_x_um;
  made.kernel = field.kernel;
  return made;
}

}  // namespace fvd::metrology
