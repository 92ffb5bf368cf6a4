#include "daemon/evaluation/section_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/metrology/edge/rounding.hpp"

namespace fvd {

namespace {

constexpr int kMostAlong = 400;  ///< of a section's samples; a picture shows no more
constexpr int kMostAcross = 40;

struct Sample {
  double along_um = 0.0;
  double surface_um = 0.0;
  double measured_um = 0.0;
};

struct Line {
  double at_start = 0.0;
  double slope = 0.0;
  [[nodiscard]] double operator()(double along_um) const { return at_start + slope * along_um; }
};

struct Range {
  double from_um = 0.0;
  double to_um = 0.0;
  [[nodiscard]] bool has(double along_um) const { return along_um >= from_um && along_um <= to_um; }
};

/// Along the section, means over the points across the band that both surfaces have; none where these are under half.
std::vector<Sample> samples_of(const MeasurementInput& input, const CrossSection& section) {
  const metrology::HeightField& surface = input.surface.field;
  const metrology::HeightField& measured = input.measured.field;
  std::vector<Sample> samples;
  const double length_um = section.length_um();
  if (surface.width() != measured.width() || surface.height() != measured.height() || length_um <= 0.0) return samples;
  const double pitch_um = std::min(surface.pitch_x_um, surface.pitch_y_um);
  const auto steps = [pitch_um](double um, int most) {
    return static_cast<int>(std::clamp(std::round(um / pitch_um), 1.0, static_cast<double>(most)));
  };
  const int along = steps(length_um, kMostAlong);
  const int across = steps(section.band_width_um, kMostAcross);
  const double x_along = (section.to_x_um - section.from_x_um) / length_um;
  const double y_along = (section.to_y_um - section.from_y_um) / length_um;
  for (int i = 0; i < along; ++i) {
    Sample sample{(i + 0.5) / along * length_um, 0.0, 0.0};
    int valid = 0;
    for (int k = 0; k < across; ++k) {
      const double beside_um = ((k + 0.5) / across - 0.5) * section.band_width_um;
      const double column = (section.from_x_um + x_along * sample.along_um - y_along * beside_um) / surface.pitch_x_um;
      const double row = (section.from_y_um + y_along * sample.along_um + x_along * beside_um) / surface.pitch_y_um;
      if (column < 0.0 || row < 0.0 || column >= surface.width() || row >= surface.height()) continue;
      const double z_um = surface.z_um.at(static_cast<int>(column), static_cast<int>(row));
      const double measured_um = measured.z_um.at(static_cast<int>(column), static_cast<int>(row));
      if (std::isnan(z_um) || std::isnan(measured_um)) continue;
      sample.surface_um += z_um;
      sample.measured_um += measured_um;
      ++valid;
    }
    if (2 * valid < across) continue;
    sample.surface_um /= valid;
    sample.measured_um *= input.measured.z_scale / valid;  // as the scan told it, and its files
    samples.push_back(sample);
  }
  return samples;
}

/// Least squares; a level line through a single place; nothing without one.
std::optional<Line> line_through(const std::vector<Sample>& samples, const std::function<bool(const Sample&)>& counts,
                                 const std::function<double(const Sample&)>& value) {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const Sample& sample : samples) {
    if (!counts(sample)) continue;
    ++n;
    x += sample.along_um;
    y += value(sample);
    xx += sample.along_um * sample.along_um;
    xy += sample.along_um * value(sample);
  }
  if (n < 1.0) return std::nullopt;
  const double spread = xx - x * x / n;
  const double slope = n > 1.0 && spread > 0.0 ? (xy - x * y / n) / spread : 0.0;
  return Line{(y - slope * x) / n, slope};
}

/// Measured less evaluated height.
std::optional<Line> taken_away(const std::vector<Sample>& samples, const std::function<bool(const Sample&)>& counts) {
  return line_through(samples, counts, [](const Sample& sample) { return sample.measured_um - sample.surface_um; });
}

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

void add_point(double along_um, double z_um, CrossSection::Curve& curve) {
  curve.along_um.push_back(rounded(along_um, 1e3));
  curve.z_um.push_back(rounded(z_um, 1e4));
}

void add_line(const Range& range, const Line& line, CrossSection& section) {
  const double from_um = std::max(range.from_um, 0.0);
  const double to_um = std::min(range.to_um, section.length_um());
  if (to_um <= from_um) return;
  CrossSection::Curve curve;
  add_point(from_um, line(from_um), curve);
  add_point(to_um, line(to_um), curve);
  section.fit.push_back(std::move(curve));
  section.fit_name = "fitted lines";
}

Line sum(const Line& a, const Line& b) { return {a.at_start + b.at_start, a.slope + b.slope}; }

struct GrooveRanges {
  Range first;
  Range second;
  Range bottom;
  Range all;
  [[nodiscard]] bool on_shoulders(double along_um) const { return first.has(along_um) || second.has(along_um); }
};

GrooveRanges ranges_of(const metrology::GrooveEdges& edges) {
  const auto [a, b, c] = metrology::groove_regions(edges);
  return {{a.from_um, a.to_um},
          {b.from_um, b.to_um},
          {c.from_um, c.to_um},
          {std::min(a.from_um, b.from_um), std::max(a.to_um, b.to_um)}};
}

/// The line of this slope through the samples at the places that count, over the range.
void add_groove_line(const std::vector<Sample>& samples, const std::function<bool(double along_um)>& counts,
                     double slope, const Range& range, CrossSection& section) {
  const auto difference = taken_away(samples, [&](const Sample& at) { return counts(at.along_um); });
  if (!difference) return;
  double sum_um = 0.0;
  double count = 0.0;
  for (const Sample& sample : samples) {
    if (!counts(sample.along_um)) continue;
    sum_um += sample.surface_um - slope * sample.along_um;
    ++count;
  }
  add_line(range, sum({sum_um / count, slope}, *difference), section);
}

/// Least squares through the measured heights of the range: what of the square no line explains is orthogonal to lines.
void add_parabola(const std::vector<Sample>& samples, const Range& range, CrossSection& section) {
  const auto within = [&range](const Sample& at) { return range.has(at.along_um); };
  const auto measured = [](const Sample& at) { return at.measured_um; };
  const auto square = [](const Sample& at) { return at.along_um * at.along_um; };
  const auto line = line_through(samples, within, measured);
  const auto line_of_square = line_through(samples, within, square);
  if (!line || !line_of_square) return;
  double products = 0.0;
  double squares = 0.0;
  for (const Sample& at : samples) {
    if (!within(at)) continue;
    const double bend = square(at) - (*line_of_square)(at.along_um);
    products += bend * (at.measured_um - (*line)(at.along_um));
    squares += bend * bend;
  }
  const double curvature = squares > 0.0 ? products / squares : 0.0;
  constexpr int kPoints = 30;
  CrossSection::Curve curve;
  for (int i = 0; i <= kPoints; ++i) {
    const double along_um = range.from_um + (range.to_um - range.from_um) * i / kPoints;
    const double bend = along_um * along_um - (*line_of_square)(along_um);
    add_point(along_um, (*line)(along_um) + curvature * bend, curve);
  }
  section.fit.push_back(std::move(curve));
  section.fit_name = "fitted lines";
}

/// Points of a rounding between two flanks, from the first to the second.
struct Wedge {
  double apex_um = 0.0;  ///< along the section
  double apex_z_um = 0.0;
  Line first;
  Line second;
};

/// The point at this distance from the apex on a flank; direction: -1 towards the section's start.
std::pair<double, double> on_flank(const Wedge& wedge, const Line& flank, double distance_um, double direction) {
  const double along_um = direction * distance_um / std::hypot(1.0, flank.slope);
  return {wedge.apex_um + along_um, wedge.apex_z_um + flank.slope * along_um};
}

/// The conic's weight that leaves this least distance from the apex: the heavier, the nearer.
double weight_for(metrology::edge::Rounding rounding, double delta_r_um) {
  double low = -7.0;
  double high = 7.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2.0;
    rounding.weight = std::exp(middle);
    (metrology::edge::nearest_to_apex(rounding).delta_r_um > delta_r_um ? low : high) = middle;
  }
  return std::exp((low + high) / 2.0);
}

/// The model's rounding by its figures; nothing where the section has none.
std::optional<metrology::edge::Rounding> rounding_of(const metrology::EdgeSection& section) {
  using metrology::EdgeQuantity;
  const auto beta_deg = section.value(EdgeQuantity::kBeta);
  const auto s_gamma = section.value(EdgeQuantity::kSGamma);
  const auto s_alpha = section.value(EdgeQuantity::kSAlpha);
  const auto delta_r = section.value(EdgeQuantity::kDeltaR);
  if (!beta_deg || !s_gamma || !s_alpha || !delta_r) return std::nullopt;
  if (*s_gamma <= 0.0 || *s_alpha <= 0.0 || *delta_r <= 0.0) return std::nullopt;
  metrology::edge::Rounding rounding{*beta_deg * std::numbers::pi / 180.0, *s_gamma, *s_alpha, 1.0};
  rounding.weight = weight_for(rounding, *delta_r);
  return rounding;
}

void add_rounding(const Wedge& wedge, double first_um, double second_um, double weight, CrossSection::Curve& curve) {
  const auto begin = on_flank(wedge, wedge.first, first_um, -1.0);
  const auto end = on_flank(wedge, wedge.second, second_um, 1.0);
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = static_cast<double>(i) / kPoints;
    const double a = (1.0 - t) * (1.0 - t);
    const double b = 2.0 * weight * t * (1.0 - t);
    const double c = t * t;
    add_point((a * begin.first + b * wedge.apex_um + c * end.first) / (a + b + c),
              (a * begin.second + b * wedge.apex_z_um + c * end.second) / (a + b + c), curve);
  }
}

bool rake_comes_first(const std::string& rake_side, const CrossSection& section) {
  if (rake_side == "right") return section.to_x_um < section.from_x_um;
  if (rake_side == "top") return section.from_y_um < section.to_y_um;
  if (rake_side == "bottom") return section.to_y_um < section.from_y_um;
  return section.from_x_um < section.to_x_um;
}

}  // namespace

void add_groove_fit(const MeasurementInput& input, const metrology::GrooveEdges& edges, double slope,
                    CrossSection& section) {
  const std::vector<Sample> samples = samples_of(input, section);
  const GrooveRanges ranges = ranges_of(edges);
  add_groove_line(
      samples, [&](double at_um) { return ranges.on_shoulders(at_um); }, slope, ranges.all, section);
  add_groove_line(
      samples, [&](double at_um) { return ranges.bottom.has(at_um); }, slope, ranges.bottom, section);
}

void add_rounded_groove_fit(const MeasurementInput& input, const metrology::GrooveEdges& edges, double slope,
                            CrossSection& section) {
  const std::vector<Sample> samples = samples_of(input, section);
  const GrooveRanges ranges = ranges_of(edges);
  add_groove_line(
      samples, [&](double at_um) { return ranges.on_shoulders(at_um); }, slope, ranges.all, section);
  add_parabola(samples, ranges.bottom, section);
}

void add_plane_fit(const MeasurementInput& input, std::span<const FittedRegion> regions, double slope_x, double slope_y,
                   CrossSection& section) {
  const std::vector<Sample> samples = samples_of(input, section);
  const double length_um = section.length_um();
  if (samples.empty()) return;
  const double x_along = (section.to_x_um - section.from_x_um) / length_um;
  const double y_along = (section.to_y_um - section.from_y_um) / length_um;
  for (const FittedRegion& fitted : regions) {
    const auto crossed =
        std::find_if(section.regions.begin(), section.regions.end(),
                     [&](const CrossSection::Region& region) { return region.name == fitted.region.name; });
    if (crossed == section.regions.end()) continue;
    const Range range{crossed->from_um, crossed->to_um};
    const auto difference = taken_away(samples, [&](const Sample& at) { return range.has(at.along_um); });
    const auto centre = centre_of(input.surface.field, *fitted.region.points);
    if (!difference) continue;
    const double at_start_um =
        fitted.mean_z_um + slope_x * (section.from_x_um - centre.x_um) + slope_y * (section.from_y_um - centre.y_um);
    add_line(range, sum({at_start_um, slope_x * x_along + slope_y * y_along}, *difference), section);
  }
}

void add_edge_fit(const MeasurementInput& input, const metrology::CuttingEdge& edge, CrossSection& section) {
  const metrology::EdgeSection* const middle = middle_section(edge);
  if (middle == nullptr || section.regions.size() != 2) return;
  const std::vector<Sample> samples = samples_of(input, section);
  const auto flank = [&](const CrossSection::Region& region) {
    const Range range{region.from_um, region.to_um};
    return line_through(
        samples, [&](const Sample& at) { return range.has(at.along_um); },
        [](const Sample& at) { return at.measured_um; });
  };
  const auto first = flank(section.regions[0]);
  const auto second = flank(section.regions[1]);
  if (!first || !second || first->slope <= second->slope) return;  // no convex edge in this picture
  Wedge wedge{(second->at_start - first->at_start) / (first->slope - second->slope), 0.0, *first, *second};
  wedge.apex_z_um = (*first)(wedge.apex_um);
  const double from_um = section.regions[0].from_um;
  const double to_um = section.regions[1].to_um;
  if (wedge.apex_um <= from_um || wedge.apex_um >= to_um) return;
  CrossSection::Curve curve;
  add_point(from_um, (*first)(from_um), curve);
  const auto rounding = rounding_of(*middle);
  if (rounding) {
    const bool rake_first = rake_comes_first(input.planned.rake_side, section);
    add_rounding(wedge, rake_first ? rounding->s_gamma_um : rounding->s_alpha_um,
                 rake_first ? rounding->s_alpha_um : rounding->s_gamma_um, rounding->weight, curve);
  } else {
    add_point(wedge.apex_um, wedge.apex_z_um, curve);
  }
  add_point(to_um, (*second)(to_um), curve);
  section.fit.push_back(std::move(curve));
  section.fit_name = rounding ? "model, without the focus window's rounding" : "flanks";
}

}  // namespace fvd
