#include "core/metrology/edge/flank_lines.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace fvd::metrology::edge {
namespace {

// Flanks that turn by less than this make no edge.
constexpr double kLeastTurn = 0.05;

}  // namespace

std::optional<FlankLines> find_flank_lines(const SectionData& section, const EdgeOptions& options) {
  std::vector<double> s[2];
  std::vector<double> h[2];
  std::vector<double> weight[2];
  for (std::size_t i = 0; i < section.s_um.size(); ++i) {
    const double away = std::abs(section.s_um[i]);
    if (away < options.flank_from_um || away > options.flank_to_um) continue;
    const std::size_t side = section.s_um[i] < 0.0 ? 0 : 1;
    s[side].push_back(section.s_um[i]);
    h[side].push_back(section.h_um[i]);
    weight[side].push_back(section.weight[i]);
  }
  if (s[0].size() < 3 || s[1].size() < 3) return std::nullopt;
  const Polynomial rake = robust_polynomial(s[0], h[0], 1, weight[0]);
  const Polynomial clearance = robust_polynomial(s[1], h[1], 1, weight[1]);
  const double rise = rake.slope(0.0);
  const double fall = clearance.slope(0.0);
  if (rise - fall < kLeastTurn) return std::nullopt;
  FlankLines lines;
  lines.apex_s_um = (clearance(0.0) - rake(0.0)) / (rise - fall);
  lines.apex_h_um = rake(lines.apex_s_um);
  lines.rake_rad = std::atan(rise);
  lines.clearance_rad = -std::atan(fall);
  if (std::abs(lines.apex_s_um) > options.flank_to_um / 2.0) return std::nullopt;
  std::vector<double> residuals;
  for (std::size_t i = 0; i < s[0].size(); ++i) residuals.push_back(h[0][i] - rake(s[0][i]));
  for (std::size_t i = 0; i < s[1].size(); ++i) residuals.push_back(h[1][i] - clearance(s[1][i]));
  lines.noise_um = robust_sd(std::move(residuals));
  return lines;
}

}  // namespace fvd::metrology::edge
