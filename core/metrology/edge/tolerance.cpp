#include "core/metrology/edge/tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace fvd::metrology::edge {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// away from the apex along a flank's line, deep below it; both um.
struct FlankPoint {
  double away, deep;
};

// points: from the apex outwards.
std::optional<double> end_of_rounding(const std::vector<FlankPoint>& points, double tolerance_um) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].deep > tolerance_um) continue;
    if (i == 0) return std::fmax(0.0, points[i].away);
    const FlankPoint& inner = points[i - 1];
    const double share = (inner.deep - tolerance_um) / (inner.deep - points[i].deep);
    return std::fmax(0.0, inner.away + share * (points[i].away - inner.away));
  }
  return std::nullopt;
}

struct FootPoint {
  double distance, angle_rad;  ///< as seen from the apex
};

// The nearest point of the piece of contour that ends at this node.
FootPoint nearest_on(const SectionData& section, std::size_t node, const FlankLines& lines) {
  const double x = section.s_um[node - 1] - lines.apex_s_um;
  const double y = section.h_um[node - 1] - lines.apex_h_um;
  const double dx = section.s_um[node] - section.s_um[node - 1];
  const double dy = section.h_um[node] - section.h_um[node - 1];
  const double share = std::clamp(-(x * dx + y * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return {std::hypot(x + share * dx, y + share * dy), std::atan2(y + share * dy, x + share * dx)};
}

}  // namespace

std::optional<ToleranceFigures> measure_by_tolerance(const SectionData& section, const FlankLines& lines,
                                                     const EdgeOptions& options) {
  std::vector<FlankPoint> rake;
  std::vector<FlankPoint> clearance;
  const double rake_x = std::cos(lines.rake_rad);
  const double rake_y = std::sin(lines.rake_rad);
  const double clearance_x = std::cos(lines.clearance_rad);
  const double clearance_y = std::sin(lines.clearance_rad);
  // Directions of both flanks away from the apex are (-rake_x, -rake_y) and (clearance_x, -clearance_y).
  const double bisector = std::atan2(-rake_y - clearance_y, clearance_x - rake_x);
  double nearest = std::numeric_limits<double>::infinity();
  ToleranceFigures figures;
  for (std::size_t i = 0; i < section.s_um.size(); ++i) {
    const double x = section.s_um[i] - lines.apex_s_um;
    const double y = section.h_um[i] - lines.apex_h_um;
    if (x < 0.0) rake.insert(rake.begin(), {-x * rake_x - y * rake_y, x * rake_y - y * rake_x});
    if (x >= 0.0) clearance.push_back({x * clearance_x - y * clearance_y, -x * clearance_y - y * clearance_x});
    if (i > 0) {
      const FootPoint foot = nearest_on(section, i, lines);
      if (foot.distance >= nearest) continue;
      nearest = foot.distance;
      // Counter-clockwise against the bisector, which points into the wedge, is towards the clearance.
      figures.phi_deg = std::remainder(foot.angle_rad - bisector, 2.0 * std::numbers::pi) * kDegrees;
    }
  }
  const auto s_gamma = end_of_rounding(rake, options.tolerance_um);
  const auto s_alpha = end_of_rounding(clearance, options.tolerance_um);
  if (!s_gamma || !s_alpha) return std::nullopt;
  figures.beta_deg = 180.0 - (lines.rake_rad + lines.clearance_rad) * kDegrees;
  figures.s_gamma_um = *s_gamma;
  figures.s_alpha_um = *s_alpha;
  figures.delta_r_um = nearest;
  return figures;
}

}  // namespace fvd::metrology::edge
