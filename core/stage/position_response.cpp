#include "core/stage/position_response.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fvd {

namespace {

void visit(Approach& approach, double error_um) {
  ++approach.visits;
  const double off = error_um - approach.mean_error_um;
  approach.mean_error_um += off / approach.visits;
  approach.sum_of_squares_um2 += off * (error_um - approach.mean_error_um);
}

}  // namespace

double same_position_um(double step_quantum_um) { return std::max(step_quantum_um / 2, 1e-6); }

std::vector<PositionResponse> responses(const std::vector<StagePoint>& points, const std::vector<double>& error_um,
                                        double step_quantum_um) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&points](std::size_t a, std::size_t b) { return points[a].quantised_um < points[b].quantised_um; });
  const double gap = same_position_um(step_quantum_um);
  std::vector<PositionResponse> list;
  for (const std::size_t i : order) {
    const StagePoint& point = points[i];
    if (list.empty() || point.quantised_um - list.back().quantised_um > gap)
      list.push_back({point.quantised_um, {}, {}});
    visit(point.direction > 0 ? list.back().below : list.back().above, error_um[i]);
  }
  return list;
}

std::optional<ReversalFigures> reversal_figures(const std::vector<PositionResponse>& responses) {
  ReversalFigures figures;
  for (const auto& response : responses) {
    if (response.below.visits == 0 || response.above.visits == 0) continue;
    const double reversal = response.below.mean_error_um - response.above.mean_error_um;
    ++figures.positions;
    figures.mean_um += (reversal - figures.mean_um) / figures.positions;
    figures.max_um = std::max(figures.max_um, std::abs(reversal));
  }
  if (figures.positions == 0) return std::nullopt;
  return figures;
}

std::optional<RepeatabilityFigures> repeatability_figures(const std::vector<PositionResponse>& responses) {
  RepeatabilityFigures figures;
  double squares = 0.0;
  int freedom = 0;
  for (const auto& response : responses) {
    for (const Approach& approach : {response.below, response.above}) {
      if (approach.visits < 2) continue;
      ++figures.groups;
      squares += approach.sum_of_squares_um2;
      freedom += approach.visits - 1;
      figures.max_sd_um = std::max(figures.max_sd_um, std::sqrt(approach.sum_of_squares_um2 / (approach.visits - 1)));
    }
  }
  if (figures.groups == 0) return std::nullopt;
  figures.pooled_sd_um = std::sqrt(squares / freedom);
  return figures;
}

}  // namespace fvd
