#include "daemon/report/edge_plot.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "daemon/report/axis_ticks.hpp"

namespace fvd {

namespace {

constexpr double kLabel = 6.0;
constexpr double kLeft = 30.0;
constexpr double kBottom = 20.0;
constexpr double kGap = 12.0;
constexpr double kLineShare = 0.3;  ///< of the height, for the edge's line

std::optional<double> number_at(const nlohmann::json& object, const std::string& key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// One of the two plots over the same places along the edge.
struct Plot {
  PageRect inside;
  double from_um = 0.0;
  double to_um = 1.0;
  double low = 0.0;
  double high = 1.0;
  [[nodiscard]] double x(double along_um) const {
    return inside.x + (along_um - from_um) / (to_um - from_um) * inside.width;
  }
  [[nodiscard]] double y(double value) const { return inside.bottom() - (value - low) / (high - low) * inside.height; }
};

/// Half the distance of the sections; of a single one anything above zero.
double half_spacing_um(const EdgeAlong& edge) {
  const auto& sections = edge.sections;
  if (sections.size() < 2) return 1.0;
  const double span_um = sections.back().along_um - sections.front().along_um;
  return std::max(span_um / static_cast<double>(sections.size() - 1) / 2.0, 1e-6);
}

void draw_values_axis(Canvas& canvas, const Plot& plot, int most, const std::string& title) {
  const AxisTicks up = axis_ticks(plot.low, plot.high, most);
  for (const double value : up.values) {
    canvas.line({plot.inside.x, plot.y(value)}, {plot.inside.right(), plot.y(value)}, colour::kGrid, 0.3);
    canvas.text({plot.inside.x - 3.0, plot.y(value) + 2.0}, fixed_text(value, up.decimals),
                {.size = kLabel, .align = TextAlign::kRight});
  }
  canvas.text_upwards({plot.inside.x - 24.0, plot.inside.y + plot.inside.height / 2.0}, title,
                      {.size = kLabel, .align = TextAlign::kCentre});
}

void draw_places_axis(Canvas& canvas, const Plot& plot) {
  const AxisTicks along = axis_ticks(plot.from_um, plot.to_um, 9);
  const double bottom = plot.inside.bottom();
  for (const double value : along.values) {
    canvas.line({plot.x(value), bottom}, {plot.x(value), bottom + 2.5}, colour::kInk);
    canvas.text({plot.x(value), bottom + 9.0}, fixed_text(value, along.decimals),
                {.size = kLabel, .align = TextAlign::kCentre});
  }
  canvas.text({plot.inside.x + plot.inside.width / 2.0, bottom + 17.0}, "along the edge / µm",
              {.size = kLabel, .align = TextAlign::kCentre});
}

void hatch_unmeasured(Canvas& canvas, const Plot& plot, const EdgeAlong& edge) {
  const double half_um = half_spacing_um(edge);
  for (std::size_t i = 0; i < edge.sections.size(); ++i) {
    if (edge.sections[i].value) continue;
    const double left = plot.x(edge.sections[i].along_um - half_um);
    while (i + 1 < edge.sections.size() && !edge.sections[i + 1].value) ++i;
    const PageRect gap{left, plot.inside.y, plot.x(edge.sections[i].along_um + half_um) - left, plot.inside.height};
    canvas.fill(gap, colour::kHole, 0.25);
    canvas.hatch(gap, colour::kHole, 2.5);
  }
}

void draw_sections(Canvas& canvas, const Plot& plot, const EdgeAlong& edge) {
  std::vector<PagePoint> line;
  const auto finish = [&] {
    if (line.size() > 1) canvas.polyline(line, colour::kLine);
    line.clear();
  };
  for (const EdgeAlong::Section& section : edge.sections) {
    if (!section.value) {
      finish();
      continue;
    }
    line.push_back({plot.x(section.along_um), plot.y(*section.value)});
    canvas.disc(line.back(), 1.2, colour::kLine);
  }
  finish();
}

/// What is missing is below the form; broken where it is not measured.
void draw_edge_line(Canvas& canvas, const Plot& plot, const EdgeAlong& edge) {
  const bool told = !edge.line.empty();
  canvas.line({plot.inside.x, plot.y(0.0)}, {plot.inside.right(), plot.y(0.0)}, told ? colour::kRule : colour::kLine,
              told ? 0.5 : 0.8);
  std::vector<PagePoint> line;
  const auto finish = [&] {
    if (line.size() > 1) canvas.polyline(line, colour::kLine, 0.6);
    line.clear();
  };
  for (const EdgeAlong::Place& place : edge.line) {
    if (place.missing_um) {
      line.push_back({plot.x(place.along_um), plot.y(-*place.missing_um)});
    } else {
      finish();
    }
  }
  finish();
}

/// A notch as a wedge of its depth, as wide as that at half of it; with the edge's line only its outline.
void draw_notches(Canvas& canvas, const Plot& plot, const EdgeAlong& edge) {
  for (const EdgeAlong::Notch& notch : edge.notches) {
    const double half_um = notch.width_um;
    const PagePoint tip{plot.x(notch.along_um), plot.y(-notch.depth_um)};
    const std::vector<PagePoint> dip{
        {plot.x(notch.along_um - half_um), plot.y(0.0)}, tip, {plot.x(notch.along_um + half_um), plot.y(0.0)}};
    if (edge.line.empty()) {
      canvas.polygon(dip, colour::kBad);
    } else {
      canvas.polygon_outline(dip, colour::kBad);
    }
    canvas.text({tip.x, tip.y + 7.0}, fixed_text(notch.depth_um, 1) + " µm",
                {.size = kLabel, .ink = colour::kBad, .align = TextAlign::kCentre});
  }
  if (!edge.looked_for_notches || !edge.notches.empty()) return;
  canvas.text({plot.inside.x + plot.inside.width / 2.0, plot.y(0.0) + 9.0}, "no notch",
              {.size = kLabel, .ink = colour::kPaleInk, .align = TextAlign::kCentre});
}

void fit_values(const EdgeAlong& edge, Plot& plot) {
  double high = 0.0;
  double low = 0.0;
  for (const EdgeAlong::Section& section : edge.sections) {
    high = std::max(high, section.value.value_or(0.0));
    low = std::min(low, section.value.value_or(0.0));
  }
  if (high - low <= 0.0) high = low + 1.0;
  plot.low = low < 0.0 ? low * 1.1 : 0.0;
  plot.high = high * 1.1;
}

std::vector<EdgeAlong::Place> line_of(const nlohmann::json& told) {
  std::vector<EdgeAlong::Place> line;
  const auto from_um = number_at(told, "from_um");
  const auto every_um = number_at(told, "every_um");
  const auto missing = told.find("missing_um");
  if (!from_um || !every_um || missing == told.end() || !missing->is_array()) return line;
  for (const auto& place : *missing) {
    const double along_um = *from_um + *every_um * static_cast<double>(line.size());
    line.push_back({along_um, place.is_number() ? std::optional(place.get<double>()) : std::nullopt});
  }
  return line;
}

}  // namespace

std::optional<EdgeAlong> edge_along(const EvaluatedMeasurement& measurement) {
  if (measurement.kind != "cutting_edge") return std::nullopt;
  const auto details = nlohmann::json::parse(measurement.details, nullptr, false);
  if (!details.is_object() || !details.contains("sections") || !details["sections"].is_array()) return std::nullopt;
  EdgeAlong edge;
  for (const auto& section : details["sections"]) {
    if (const auto along_um = number_at(section, "along_um")) {
      edge.sections.push_back({*along_um, number_at(section, measurement.main_value)});
    }
  }
  if (edge.sections.empty()) return std::nullopt;
  std::sort(edge.sections.begin(), edge.sections.end(),
            [](const EdgeAlong::Section& a, const EdgeAlong::Section& b) { return a.along_um < b.along_um; });
  edge.looked_for_notches = measurement.values.count("notches") > 0;
  const auto chipping = details.find("chipping");
  if (chipping == details.end() || !chipping->is_object()) return edge;
  if (chipping->contains("line")) edge.line = line_of((*chipping)["line"]);
  if (!chipping->contains("notches")) return edge;
  for (const auto& notch : (*chipping)["notches"]) {
    edge.notches.push_back({number_at(notch, "along_um").value_or(0.0), number_at(notch, "depth_um").value_or(0.0),
                            number_at(notch, "width_um").value_or(0.0)});
  }
  return edge;
}

void draw_edge(Canvas& canvas, const PageRect& place, const EdgeAlong& edge, const std::string& name) {
  const double half_um = half_spacing_um(edge);
  const double room = place.height - kBottom - kGap;
  Plot values;
  values.from_um = edge.sections.front().along_um - half_um;
  values.to_um = edge.sections.back().along_um + half_um;
  Plot line = values;
  values.inside = {place.x + kLeft, place.y, place.width - kLeft, room * (1.0 - kLineShare)};
  line.inside = {place.x + kLeft, values.inside.bottom() + kGap, place.width - kLeft, room * kLineShare};
  fit_values(edge, values);
  double deepest_um = 1.0;
  double highest_um = 0.0;
  for (const EdgeAlong::Notch& notch : edge.notches) deepest_um = std::max(deepest_um, notch.depth_um);
  for (const EdgeAlong::Place& spot : edge.line) {
    deepest_um = std::max(deepest_um, spot.missing_um.value_or(0.0));
    highest_um = std::max(highest_um, -spot.missing_um.value_or(0.0));
  }
  line.low = -1.6 * deepest_um;  // with the words below a notch
  line.high = std::max(0.25 * deepest_um, 1.1 * highest_um);
  draw_values_axis(canvas, values, 7, name);
  draw_values_axis(canvas, line, 3, "edge line / µm");
  draw_places_axis(canvas, line);
  hatch_unmeasured(canvas, values, edge);
  hatch_unmeasured(canvas, line, edge);
  draw_sections(canvas, values, edge);
  canvas.begin_clip(line.inside);
  draw_edge_line(canvas, line, edge);
  draw_notches(canvas, line, edge);
  canvas.end_clip();
  canvas.frame(values.inside, colour::kPaleInk);
  canvas.frame(line.inside, colour::kPaleInk);
}

}  // namespace fvd
