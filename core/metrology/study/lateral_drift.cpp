#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Core>

#include "core/metrology/study/lateral_grid.hpp"

namespace fvd::metrology {
namespace {

constexpr int kFewestCrossings = 6;

struct Pair {
  Eigen::Vector2d first;
  Eigen::Vector2d second;
};

std::vector<Pair> pairs_of(std::span<const GridCrossing> at_first, std::span<const GridCrossing> at_second) {
  std::map<std::pair<int, int>, Eigen::Vector2d> places;
  for (const GridCrossing& crossing : at_first) {
    places.try_emplace({crossing.index_x, crossing.index_y}, crossing.column, crossing.row);
  }
  std::vector<Pair> pairs;
  for (const GridCrossing& crossing : at_second) {
    const auto found = places.find({crossing.index_x, crossing.index_y});
    if (found == places.end()) continue;
    pairs.push_back({found->second, {crossing.column, crossing.row}});
    places.erase(found);
  }
  return pairs;
}

}  // namespace

StudyOutcome<LateralDrift> lateral_drift(std::span<const GridCrossing> at_first, double z_first_um,
                                         std::span<const GridCrossing> at_second, double z_second_um) {
  const double rise_um = z_second_um - z_first_um;
  if (!(std::abs(rise_um) > 0.0)) return StudyRefusal{"both heights of the grid are the same"};
  const std::vector<Pair> pairs = pairs_of(at_first, at_second);
  const auto n = static_cast<int>(pairs.size());
  if (n < kFewestCrossings) {
    return StudyRefusal{std::to_string(n) + " crossings are seen at both heights, at least " +
                        std::to_string(kFewestCrossings) + " are needed"};
  }
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d movement = Eigen::Vector2d::Zero();
  for (const Pair& pair : pairs) {
    middle += pair.first / n;
    movement += (pair.second - pair.first) / n;
  }
  double squares = 0.0;
  double products = 0.0;
  for (const Pair& pair : pairs) {
    const Eigen::Vector2d arm = pair.first - middle;
    squares += arm.squaredNorm();
    products += arm.dot(pair.second - pair.first - movement);
  }
  if (!(squares > 0.0)) return StudyRefusal{"all crossings are at the same place"};
  return LateralDrift{movement.x() / rise_um, movement.y() / rise_um, 1000.0 * products / squares / rise_um, n};
}

}  // namespace fvd::metrology
