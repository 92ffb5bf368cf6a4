#include "core/metrology/study/lateral_grid.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/random_normal.hpp"

namespace fvd::metrology {
namespace {

struct Optics {
  double pitch_x_um = 0.5;
  double pitch_y_um = 0.52;
  double shear = 0.01;
  double angle_deg = 3.0;
};

/// What these optics show of a grid of 10 um, lines -reach to reach about those with the numbers 7 and 12.
std::vector<GridCrossing> seen(const Optics& optics, int reach_x, int reach_y) {
  const double angle = optics.angle_deg * M_PI / 180.0;
  std::vector<GridCrossing> crossings;
  for (int j = -reach_y; j <= reach_y; ++j) {
    for (int i = -reach_x; i <= reach_x; ++i) {
      const double x_um = 10.0 * (i * std::cos(angle) - j * std::sin(angle));
      const double y_um = 10.0 * (i * std::sin(angle) + j * std::cos(angle));
      crossings.push_back(
          {240.0 + (x_um - optics.shear * y_um) / optics.pitch_x_um, 180.0 + y_um / optics.pitch_y_um, 7 + i, 12 + j});
    }
  }
  return crossings;
}

LateralGrid fitted(std::span<const GridCrossing> crossings, double u_relative = 0.0) {
  return std::get<LateralGrid>(lateral_grid(crossings, 10.0, u_relative));
}

bool refused(std::span<const GridCrossing> crossings) {
  return std::holds_alternative<StudyRefusal>(lateral_grid(crossings, 10.0));
}

TEST(LateralGrid, FindsPitchShearAndAngle) {
  for (const Optics& optics : {Optics{}, Optics{0.25, 0.25, -0.02, -12.0}, Optics{1.0, 0.9, 0.0, 40.0}}) {
    const LateralGrid grid = fitted(seen(optics, 5, 4));

    EXPECT_NEAR(grid.pitch_x_um, optics.pitch_x_um, 1e-12);
    EXPECT_NEAR(grid.pitch_y_um, optics.pitch_y_um, 1e-12);
    EXPECT_NEAR(grid.shear, optics.shear, 1e-12);
    EXPECT_NEAR(grid.angle_deg, optics.angle_deg, 1e-10);
    EXPECT_NEAR(grid.deviation_max_um, 0.0, 1e-10);
    EXPECT_NEAR(grid.u_pitch_x_um, 0.0, 1e-12);
  }
}

TEST(LateralGrid, TellsWhatTheMapLeavesOver) {
  const Optics optics;
  std::vector<GridCrossing> crossings = seen(optics, 5, 5);
  crossings[60].column += 0.3;  // the middle one, which does not turn or stretch the fit
  crossings[60].row -= 0.2;

  const LateralGrid grid = fitted(crossings);

  const double y_um = -0.2 * optics.pitch_y_um;
  const double x_um = 0.3 * optics.pitch_x_um + optics.shear * y_um;
  ASSERT_EQ(grid.deviations_x_um.size(), 121U);
  EXPECT_NEAR(grid.pitch_x_um, optics.pitch_x_um, 1e-12);
  EXPECT_NEAR(grid.deviations_x_um[60], x_um * 120.0 / 121.0, 1e-10);
  EXPECT_NEAR(grid.deviations_y_um[60], y_um * 120.0 / 121.0, 1e-10);
  EXPECT_NEAR(grid.deviations_x_um[0], -x_um / 121.0, 1e-10);
  EXPECT_NEAR(grid.deviation_max_um, std::hypot(x_um, y_um) * 120.0 / 121.0, 1e-10);
  // 1 of (120 / 121)^2 and 120 of (1 / 121)^2, over 121.
  EXPECT_NEAR(grid.deviation_rms_um, std::hypot(x_um, y_um) * std::sqrt(120.0 / 121.0 / 121.0), 1e-10);
}

TEST(LateralGrid, HasTheUncertaintyThatDrawsShow) {
  // Columns and rows scatter differently, so that they are not confused.
  constexpr int kDraws = 2000;
  for (const Optics& optics : {Optics{0.5, 0.9, 0.1, 0.0}, Optics{0.5, 0.9, -0.3, 30.0}}) {
    const std::vector<GridCrossing> truth = seen(optics, 9, 1);
    RandomNormal random(6);
    std::array<double, 2> squares{};
    std::array<double, 2> stated{};
    for (int draw = 0; draw < kDraws; ++draw) {
      std::vector<GridCrossing> crossings = truth;
      for (GridCrossing& crossing : crossings) {
        crossing.column += 0.02 * random.normal();
        crossing.row += 0.05 * random.normal();
      }
      const LateralGrid grid = fitted(crossings);
      squares[0] += std::pow(grid.pitch_x_um - optics.pitch_x_um, 2) / kDraws;
      squares[1] += std::pow(grid.pitch_y_um - optics.pitch_y_um, 2) / kDraws;
      stated[0] += grid.u_pitch_x_um * grid.u_pitch_x_um / kDraws;
      stated[1] += grid.u_pitch_y_um * grid.u_pitch_y_um / kDraws;
    }

    EXPECT_NEAR(std::sqrt(stated[0] / squares[0]), 1.0, 0.065) << optics.angle_deg;
    EXPECT_NEAR(std::sqrt(stated[1] / squares[1]), 1.0, 0.065) << optics.angle_deg;
  }
}

TEST(LateralGrid, HasTheUncertaintyOfItsDerivatives) {
  std::vector<GridCrossing> crossings = seen({0.5, 0.9, -0.3, 30.0}, 4, 1);
  RandomNormal random(2);
  for (GridCrossing& crossing : crossings) {
    crossing.column += 0.02 * random.normal();
    crossing.row += 0.2 * random.normal();
  }

  const LateralGrid grid = fitted(crossings);

  std::array<double, 2> place_variance{};  // of columns and rows, in px^2
  for (std::size_t i = 0; i < 27; ++i) {
    const double column = (grid.deviations_x_um[i] - grid.shear * grid.deviations_y_um[i]) / grid.pitch_x_um;
    place_variance[0] += column * column / 24.0;
    place_variance[1] += std::pow(grid.deviations_y_um[i] / grid.pitch_y_um, 2) / 24.0;
  }
  double variance_x = 0.0;
  double variance_y = 0.0;
  for (GridCrossing& crossing : crossings) {
    for (double GridCrossing::*coordinate : {&GridCrossing::column, &GridCrossing::row}) {
      const double here = crossing.*coordinate;
      crossing.*coordinate = here + 1e-3;
      const LateralGrid above = fitted(crossings);
      crossing.*coordinate = here - 1e-3;
      const LateralGrid below = fitted(crossings);
      crossing.*coordinate = here;
      const double variance = place_variance[coordinate == &GridCrossing::column ? 0 : 1];
      variance_x += variance * std::pow((above.pitch_x_um - below.pitch_x_um) / 2e-3, 2);
      variance_y += variance * std::pow((above.pitch_y_um - below.pitch_y_um) / 2e-3, 2);
    }
  }
  EXPECT_NEAR(grid.u_pitch_x_um / std::sqrt(variance_x), 1.0, 1e-6);
  EXPECT_NEAR(grid.u_pitch_y_um / std::sqrt(variance_y), 1.0, 1e-6);
}

TEST(LateralGrid, CountsThePlacesThatTheFitUses) {
  std::vector<GridCrossing> crossings = seen({0.5, 0.5, 0.0, 0.0}, 1, 1);
  crossings[4].column += 0.3;

  const LateralGrid grid = fitted(crossings);

  // s^2 = 0.09 (8 / 9) / (9 - 3) along the columns; a step of 20 columns rests on six places one step from the middle.
  EXPECT_NEAR(grid.u_pitch_x_um, std::sqrt(0.09 * 8.0 / 9.0 / 6.0 / 6.0) * 0.5 / 20.0, 1e-12);
  EXPECT_NEAR(grid.u_pitch_y_um, 0.0, 1e-12);
}

TEST(LateralGrid, AddsTheUncertaintyOfTheGrid) {
  const LateralGrid grid = fitted(seen({}, 3, 3), 1e-4);

  EXPECT_NEAR(grid.u_pitch_x_um, 0.5e-4, 1e-12);
  EXPECT_NEAR(grid.u_pitch_y_um, 0.52e-4, 1e-12);
}

TEST(LateralGrid, IsRefusedWhereCrossingsCannotTellIt) {
  const std::vector<GridCrossing> crossings = seen({}, 1, 1);
  std::vector<GridCrossing> in_a_row = seen({}, 5, 0);
  std::vector<GridCrossing> same_row = seen({}, 2, 1);
  std::vector<GridCrossing> mirrored = seen({}, 2, 2);
  for (GridCrossing& crossing : same_row) crossing.row = 7.0;
  for (GridCrossing& crossing : mirrored) crossing.index_y = 24 - crossing.index_y;

  EXPECT_FALSE(refused(std::span(crossings).first(6)));
  EXPECT_TRUE(refused(std::span(crossings).first(5)));
  EXPECT_TRUE(refused(in_a_row));
  EXPECT_TRUE(refused(same_row));
  EXPECT_TRUE(refused(mirrored));
}

TEST(LateralGrid, NeedsThePitchOfTheGrid) {
  const std::vector<GridCrossing> crossings = seen({}, 2, 2);
  EXPECT_THROW(static_cast<void>(lateral_grid(crossings, 0.0)), Error);
  EXPECT_THROW(static_cast<void>(lateral_grid(crossings, 10.0, -1.0)), Error);
}

/// The same grid, moved and magnified about the mean place of the crossings.
std::vector<GridCrossing> moved(std::vector<GridCrossing> crossings, double right_px, double down_px, double larger) {
  for (GridCrossing& crossing : crossings) {
    crossing.column = 240.0 + (crossing.column - 240.0) * (1.0 + larger) + right_px;
    crossing.row = 180.0 + (crossing.row - 180.0) * (1.0 + larger) + down_px;
  }
  return crossings;
}

TEST(LateralDrift, IsMovementAndMagnificationPerHeight) {
  const std::vector<GridCrossing> low = seen({}, 4, 3);
  std::vector<GridCrossing> high = moved(low, 1.5, -0.5, 0.002);
  std::swap(high[2], high[40]);

  const LateralDrift up = std::get<LateralDrift>(lateral_drift(low, 10.0, high, 60.0));

  EXPECT_NEAR(up.x_px_per_um, 0.03, 1e-12);
  EXPECT_NEAR(up.y_px_per_um, -0.01, 1e-12);
  EXPECT_NEAR(up.magnification_per_mm, 0.04, 1e-10);
  EXPECT_EQ(up.crossings, 63);
}

TEST(LateralDrift, HasItsSignWhicheverHeightIsFirst) {
  const std::vector<GridCrossing> low = seen({}, 4, 3);
  const std::vector<GridCrossing> high = moved(low, 1.5, -0.5, 0.0);

  const LateralDrift down = std::get<LateralDrift>(lateral_drift(high, 60.0, low, 10.0));

  EXPECT_NEAR(down.x_px_per_um, 0.03, 1e-12);
  EXPECT_NEAR(down.y_px_per_um, -0.01, 1e-12);
}

TEST(LateralDrift, LooksAtCrossingsThatAreSeenTwice) {
  const std::vector<GridCrossing> low = seen({}, 1, 1);
  const std::vector<GridCrossing> high = moved(low, 1.5, -0.5, 0.0);
  const std::span<const GridCrossing> all(high);

  const StudyOutcome<LateralDrift> six = lateral_drift(low, 0.0, all.first(6), 50.0);

  ASSERT_TRUE(std::holds_alternative<LateralDrift>(six));
  EXPECT_EQ(std::get<LateralDrift>(six).crossings, 6);
  EXPECT_NEAR(std::get<LateralDrift>(six).x_px_per_um, 0.03, 1e-12);
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(lateral_drift(low, 0.0, all.first(5), 50.0)));
  std::vector<GridCrossing> twice(all.begin(), all.begin() + 5);
  twice.push_back(twice.front());
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(lateral_drift(low, 0.0, twice, 50.0)));
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(lateral_drift(low, 50.0, high, 50.0)));
}

}  // namespace
}  // namespace fvd::metrology
