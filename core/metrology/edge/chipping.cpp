#include "core/metrology/edge/chipping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/metrology/edge/notches.hpp"
#include "core/metrology/edge/robust.hpp"

namespace fvd::metrology::edge {
namespace {

constexpr double kRobustLimit = 5.0;
constexpr std::size_t kParts = 5;
constexpr double kLeastShare = 0.5;

// A place this near to a point, in pixels, is the point: its neighbour may be missing.
double snapped(double place) {
  const double nearest = std::round(place);
  return std::abs(place - nearest) < 0.02 ? nearest : place;
}

// Height between the points; absent beside a hole and at the border.
std::optional<double> height_at(const HeightField& field, const Region& region, double x_um, double y_um) {
  const double column = snapped(x_um / field.pitch_x_um - 0.5);
  const double row = snapped(y_um / field.pitch_y_um - 0.5);
  const double left = std::floor(column);
  const double top = std::floor(row);
  double sum = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const double share_x = corner % 2 == 0 ? 1.0 - (column - left) : column - left;
    const double share_y = corner < 2 ? 1.0 - (row - top) : row - top;
    // A neighbour without a part may be missing.
    if (share_x * share_y == 0.0) continue;
    const double i = left + corner % 2;
    const double j = top + static_cast<double>(corner / 2);
    if (i < 0.0 || j < 0.0 || i >= field.width() || j >= field.height()) return std::nullopt;
    const int c = static_cast<int>(i);
    const int r = static_cast<int>(j);
    if (field.is_hole(c, r) || !is_inside(region, c, r)) return std::nullopt;
    sum += share_x * share_y * field.z_um.at(c, r);
  }
  return sum;
}

// Whether there is a height at the point next to a place.
bool is_measured(const HeightField& field, const Region& region, double x_um, double y_um) {
  const double column = std::floor(x_um / field.pitch_x_um);
  const double row = std::floor(y_um / field.pitch_y_um);
  if (column < 0.0 || row < 0.0 || column >= field.width() || row >= field.height()) return false;
  const int c = static_cast<int>(column);
  const int r = static_cast<int>(row);
  return !field.is_hole(c, r) && is_inside(region, c, r);
}

struct ContourPoint {
  double s = 0.0, h = 0.0;
  bool there = false;
};

// Distance of the apex (0, 0) from the piece between two points of the contour.
double distance_to(const ContourPoint& a, const ContourPoint& b) {
  const double ds = b.s - a.s;
  const double dh = b.h - a.h;
  const double share = std::clamp(-(a.s * ds + a.h * dh) / (ds * ds + dh * dh), 0.0, 1.0);
  return std::hypot(a.s + share * ds, a.h + share * dh);
}

std::optional<double> least_distance(const std::vector<ContourPoint>& contour) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < contour.size(); ++i) {
    if (contour[i].there && contour[i + 1].there) least = std::min(least, distance_to(contour[i], contour[i + 1]));
  }
  // What is missing at s is at least |s| away.
  for (const ContourPoint& p : contour) {
    if (!p.there && std::abs(p.s) <= least) return std::nullopt;
  }
  if (!std::isfinite(least)) return std::nullopt;
  return least;
}

std::vector<EdgeLinePoint> edge_line(const HeightField& field, const Region& region, const EdgeCurve& curve,
                                     const EdgeOptions& options) {
  const double pitch = std::min(field.pitch_x_um, field.pitch_y_um);
  const auto count = static_cast<std::size_t>(curve.whole_length_um() / pitch);
  const int reach = static_cast<int>(std::ceil(options.flank_to_um / pitch));
  std::vector<EdgeLinePoint> line;
  std::vector<ContourPoint> contour(static_cast<std::size_t>(2 * reach + 1));
  for (std::size_t i = 0; i < count; ++i) {
    const double along = (static_cast<double>(i) + 0.5) * pitch;
    const EdgeFrame frame = curve.frame(curve.place_at_length(along));
    int rake = 0;
    int clearance = 0;
    int flank = 0;  // points of one of them
    for (int k = -reach; k <= reach; ++k) {
      const double s = k * pitch;
      const double x = frame.x + s * frame.u_x;
      const double y = frame.y + s * frame.u_y;
      const auto z = height_at(field, region, x, y);
      contour[static_cast<std::size_t>(k + reach)] = {s, z ? (*z - frame.z) / frame.stretch : 0.0, z.has_value()};
      if (std::abs(s) < options.flank_from_um) continue;
      flank += s > 0.0 ? 1 : 0;
      if (is_measured(field, region, x, y)) (s < 0.0 ? rake : clearance) += 1;
    }
    // Beside a flank that is not there the contour is what the window saw of the other one.
    const bool both = std::min(rake, clearance) >= kLeastShare * flank;
    line.push_back({along, frame.x, frame.y, both ? least_distance(contour) : std::nullopt, std::nullopt});
  }
  return line;
}

/// Standard deviation of the edge line from the points where no material is missing: notches, which may be a third of
/// an edge, would else raise the limit that they are found by. Of a normal distribution the median distance of one side
/// is that of both. Own definition.
double scatter_of_sound_side(const std::vector<double>& deviations_um) {
  constexpr double kMadToDeviation = 1.4826;
  std::vector<double> distances;
  for (const double deviation : deviations_um) {
    if (deviation <= 0.0) distances.push_back(-deviation);
  }
  if (distances.empty()) return 0.0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return kMadToDeviation * *middle;
}

// Takes the form off and gives the deviations that are there.
std::vector<double> remove_form(std::vector<EdgeLinePoint>& line, int degree) {
  constexpr int kRounds = 20;
  constexpr double kSound = 3.0;
  std::vector<double> along;
  std::vector<double> distance;
  for (const EdgeLinePoint& p : line) {
    if (!p.distance_um) continue;
    along.push_back(p.along_um);
    distance.push_back(*p.distance_um);
  }
  Polynomial form = robust_polynomial(along, distance, degree);
  std::vector<double> deviations(along.size());
  std::size_t kept = along.size();
  // Notches pull the form towards them, all to one side: it is fitted again to what is sound, until that does not
  // change.
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < along.size(); ++i) deviations[i] = distance[i] - form(along[i]);
    const double limit = kSound * scatter_of_sound_side(deviations);
    std::vector<double> sound_along;
    std::vector<double> sound_distance;
    for (std::size_t i = 0; i < along.size(); ++i) {
      if (deviations[i] > limit) continue;
      sound_along.push_back(along[i]);
      sound_distance.push_back(distance[i]);
    }
    if (sound_along.size() == kept || 2 * sound_along.size() < along.size()) break;
    kept = sound_along.size();
    form = robust_polynomial(sound_along, sound_distance, degree);
  }
  std::size_t at = 0;
  for (EdgeLinePoint& p : line) {
    if (!p.distance_um) continue;
    deviations[at] = distance[at] - form(along[at]);
    p.deviation_um = deviations[at++];
  }
  return deviations;
}

double height_of_part(const std::vector<EdgeLinePoint>& line, std::size_t from, std::size_t to, std::size_t& there) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  there = 0;
  for (std::size_t i = from; i < to; ++i) {
    if (!line[i].deviation_um) continue;
    ++there;
    low = std::min(low, *line[i].deviation_um);
    high = std::max(high, *line[i].deviation_um);
  }
  return high - low;
}

// Parts of which under half is measured do not count.
std::optional<double> mean_height_of_parts(const std::vector<EdgeLinePoint>& line) {
  double sum = 0.0;
  int parts = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    const std::size_t from = line.size() * part / kParts;
    const std::size_t to = line.size() * (part + 1) / kParts;
    std::size_t there = 0;
    const double height = height_of_part(line, from, to, there);
    if (static_cast<double>(there) < kLeastShare * static_cast<double>(to - from)) continue;
    sum += height;
    ++parts;
  }
  if (parts == 0) return std::nullopt;
  return sum / parts;
}

}  // namespace

ChippingResult measure_chipping(const HeightField& field, const Region& region, const EdgeCurve& curve,
                                double window_um, const EdgeOptions& options) {
  ChippingResult result;
  result.line = edge_line(field, region, curve, options);
  result.length_um = curve.whole_length_um();
  std::size_t measured = 0;
  for (const EdgeLinePoint& p : result.line) measured += p.distance_um ? 1U : 0U;
  const auto all = static_cast<double>(result.line.size());
  result.unmeasured_um = all > 0.0 ? result.length_um * (1.0 - static_cast<double>(measured) / all) : result.length_um;
  const auto degree = static_cast<std::size_t>(options.chipping.form_degree);
  if (measured < kParts * (degree + 1)) {
    result.reason = EdgeReason::kEdgeLineTooShort;
    return result;
  }
  const std::vector<double> deviations = remove_form(result.line, options.chipping.form_degree);
  result.robust_sd_um = scatter_of_sound_side(deviations);
  result.depth_limit_um = std::max(options.chipping.min_depth_um, kRobustLimit * result.robust_sd_um);
  std::size_t there = 0;
  result.edge_pt_um = height_of_part(result.line, 0, result.line.size(), there);
  result.edge_rz_um = mean_height_of_parts(result.line);
  if (!result.edge_rz_um) result.reason = EdgeReason::kEdgeLineTooShort;
  result.notches = find_notches(
      result.line, {result.depth_limit_um, options.chipping.min_width_um, result.robust_sd_um, 2.0 * window_um});
  return result;
}

}  // namespace fvd::metrology::edge
