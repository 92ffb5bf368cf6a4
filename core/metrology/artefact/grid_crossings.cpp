#include "core/metrology/artefact/grid_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <Eigen/Dense>

#include "core/metrology/artefact/grid_lattice.hpp"
#include "core/metrology/artefact/line_pieces.hpp"
#include "core/metrology/artefact/two_levels.hpp"

namespace fvd::metrology {
namespace {

constexpr std::size_t kFewestCrossings = 6;
constexpr int kRounds = 3;    ///< lattice, shape and crossings improve each other
constexpr double kFar = 9.0;  ///< medians of the distances from the lattice: so far is no crossing of it
constexpr double kNearEnough_px = 0.1;

struct Pass {
  std::vector<GridCrossing> crossings;
  int expected = 0;
  LineShape shape_x;
  LineShape shape_y;
};

std::optional<Pass> pass_over(const Plane<float>& shares, const GridLattice& lattice) {
  const auto shape_x = line_shape(shares, lattice, 0);
  const auto shape_y = line_shape(shares, lattice, 1);
  if (!shape_x || !shape_y) return std::nullopt;
  Pass pass{{}, 0, *shape_x, *shape_y};
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (const double x : {0.0, shares.width() - 1.0}) {
    for (const double y : {0.0, shares.height() - 1.0}) {
      const Eigen::Vector2d corner = lattice.index({x, y});
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  for (int j = static_cast<int>(std::floor(low.y())); j <= high.y(); ++j) {
    for (int i = static_cast<int>(std::floor(low.x())); i <= high.x(); ++i) {
      const CrossingFit fit = fit_crossing(shares, lattice, *shape_x, *shape_y, i, j);
      pass.expected += fit.expected ? 1 : 0;
      if (fit.place) pass.crossings.push_back({fit.place->x(), fit.place->y(), i, j});
    }
  }
  return pass;
}

/// Least squares; absent where the numbers lie on one line.
std::optional<GridLattice> lattice_through(const std::vector<GridCrossing>& crossings) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> vectors = Eigen::Matrix<double, 3, 2>::Zero();
  for (const GridCrossing& crossing : crossings) {
    const Eigen::Vector3d terms(1.0, crossing.index_x, crossing.index_y);
    matrix += terms * terms.transpose();
    vectors += terms * Eigen::RowVector2d(crossing.column, crossing.row);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-9)) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> solution = solver.solve(vectors);
  return GridLattice{solution.row(0).transpose(), solution.row(1).transpose(), solution.row(2).transpose()};
}

/// Leaves out crossings that lie far from where the others have them.
void drop_strays(std::vector<GridCrossing>& crossings, const GridLattice& lattice) {
  const auto off = [&](const GridCrossing& crossing) {
    return (Eigen::Vector2d(crossing.column, crossing.row) - lattice.place(crossing.index_x, crossing.index_y)).norm();
  };
  std::vector<double> distances;
  for (const GridCrossing& crossing : crossings) distances.push_back(off(crossing));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double limit = std::max(kNearEnough_px, kFar * *middle);
  crossings.erase(std::remove_if(crossings.begin(), crossings.end(),
                                 [&](const GridCrossing& crossing) { return off(crossing) > limit; }),
                  crossings.end());
}

/// Numbers from the crossing of the lattice that lies nearest to the place.
void number_from(std::vector<GridCrossing>& crossings, const GridLattice& lattice, const ImagePlace& origin) {
  const Eigen::Vector2d index = lattice.index({origin.column, origin.row});
  const int i = static_cast<int>(std::lround(index.x()));
  const int j = static_cast<int>(std::lround(index.y()));
  for (GridCrossing& crossing : crossings) {
    crossing.index_x -= i;
    crossing.index_y -= j;
  }
}

StudyRefusal too_few(std::size_t crossings, int expected) {
  return {std::to_string(crossings) + " crossings of a grid were found where " + std::to_string(expected) +
          " were to be seen; at least " + std::to_string(kFewestCrossings) + " and a quarter of them are needed"};
}

}  // namespace

StudyOutcome<CrossGridPlaces> grid_crossings(const HeightField& field, const Region& region, const GridSearch& search) {
  const StudyOutcome<TwoLevels> levels_or = two_levels(field, region);
  if (const auto* refusal = std::get_if<StudyRefusal>(&levels_or)) return *refusal;
  const TwoLevels& levels = std::get<TwoLevels>(levels_or);
  Plane<float> shares = level_shares(field, region, levels);
  const std::optional<FoundLattice> found = find_lattice(shares);
  if (!found) return StudyRefusal{"the heights have no grid: no two directions in which lines follow each other"};
  if (!found->raised) {
    for (float& share : shares.pixels()) share = 1.0F - share;
  }

  GridLattice lattice = found->lattice;
  std::optional<Pass> pass;
  for (int round = 0; round < kRounds; ++round) {
    pass = pass_over(shares, lattice);
    if (!pass) return StudyRefusal{"the heights have no grid: its lines do not stand out against the cells"};
    std::vector<GridCrossing>& crossings = pass->crossings;
    std::optional<GridLattice> through = lattice_through(crossings);
    if (through && crossings.size() >= kFewestCrossings) {
      drop_strays(crossings, *through);
      through = lattice_through(crossings);
    }
    if (!through || crossings.size() < kFewestCrossings ||
        4 * crossings.size() < static_cast<std::size_t>(pass->expected)) {
      return too_few(crossings.size(), pass->expected);
    }
    lattice = *through;
  }
  number_from(pass->crossings, lattice,
              search.origin.value_or(ImagePlace{0.5 * (field.width() - 1), 0.5 * (field.height() - 1)}));

  CrossGridPlaces places;
  places.crossings = std::move(pass->crossings);
  places.expected = pass->expected;
  places.raised = found->raised;
  places.line_height_um = levels.step_um;
  places.line_width_x_px = pass->shape_x.width_px;
  places.line_width_y_px = pass->shape_y.width_px;
  places.edge_width_px = 0.5 * (pass->shape_x.edge_px + pass->shape_y.edge_px);
  return places;
}

}  // namespace fvd::metrology
