#include "core/metrology/edge/notches.hpp"

#include <algorithm>
#include <cstddef>

namespace fvd::metrology {

double ChippingResult::deepest_um() const {
  double deepest = 0.0;
  for (const Notch& notch : notches) deepest = std::max(deepest, notch.depth_um);
  return deepest;
}

namespace edge {
namespace {

// One side of a notch, from its deepest place on.
struct Flank {
  double half_width_um = 0.0;  ///< to where half of the depth is reached
  bool open = false;           ///< the line ends, or is not measured, before that or before the form
};

Flank walk(std::span<const EdgeLinePoint> line, std::size_t deepest, int direction, double base_um) {
  const double half = *line[deepest].deviation_um / 2.0;
  Flank flank;
  bool half_reached = false;
  std::size_t i = deepest;
  while (true) {
    const bool ends = direction < 0 ? i == 0 : i + 1 == line.size();
    const std::size_t next = direction < 0 ? i - 1 : i + 1;
    if (ends || !line[next].deviation_um) {
      flank.open = true;
      const double step = std::abs(line[1].along_um - line[0].along_um);
      if (!half_reached) flank.half_width_um = std::abs(line[i].along_um - line[deepest].along_um) + step / 2.0;
      return flank;
    }
    const double before = *line[i].deviation_um;
    const double after = *line[next].deviation_um;
    if (!half_reached && after <= half) {
      half_reached = true;
      const double share = before > after ? (before - half) / (before - after) : 0.0;
      const double at = line[i].along_um + share * (line[next].along_um - line[i].along_um);
      flank.half_width_um = std::abs(at - line[deepest].along_um);
    }
    if (after <= base_um) return flank;
    i = next;
  }
}

}  // namespace

std::vector<Notch> find_notches(std::span<const EdgeLinePoint> line, const NotchLimits& limits) {
  std::vector<Notch> notches;
  const double base = std::min(limits.base_um, limits.depth_um / 2.0);
  std::size_t i = 0;
  while (i < line.size()) {
    if (!line[i].deviation_um || *line[i].deviation_um <= base) {
      ++i;
      continue;
    }
    const double step = line.size() > 1 ? std::abs(line[1].along_um - line[0].along_um) : 0.0;
    std::size_t deepest = i;
    double area = 0.0;
    for (; i < line.size() && line[i].deviation_um && *line[i].deviation_um > base; ++i) {
      if (*line[i].deviation_um > *line[deepest].deviation_um) deepest = i;
      area += *line[i].deviation_um * step;
    }
    const double depth = *line[deepest].deviation_um;
    if (depth < limits.depth_um || line.size() < 2) continue;
    const Flank left = walk(line, deepest, -1, base);
    const Flank right = walk(line, deepest, 1, base);
    const double width = left.half_width_um + right.half_width_um;
    const bool open = left.open || right.open;
    if (width < limits.width_um && !open) continue;
    notches.push_back({line[deepest].along_um, line[deepest].x_um, line[deepest].y_um, depth, width, area, open,
                       width >= limits.resolved_um});
  }
  return notches;
}

}  // namespace edge
}  // namespace fvd::metrology
