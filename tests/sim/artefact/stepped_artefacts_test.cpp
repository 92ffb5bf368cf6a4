#include "sim/artefact/stepped_artefacts.hpp"

#include <cmath>

#include "gtest/gtest.h"

namespace fvd::sim {
namespace {

TEST(Groove, HasItsWidthAtHalfItsDepthAndItsWallAngle) {
  const Groove groove{.width_um = 90.0, .depth_um = 50.0, .wall_angle_deg = 80.0, .direction_deg = 90.0};
  const double half_run = 25.0 / std::tan(80.0 * std::numbers::pi / 180.0);

  EXPECT_NEAR(level_at(groove, {45.0, 11.0}).height_um, -25.0, 1e-12);
  EXPECT_NEAR(level_at(groove, {-45.0, 11.0}).height_um, -25.0, 1e-12);
  const double rise = level_at(groove, {45.5, 0.0}).height_um - level_at(groove, {44.5, 0.0}).height_um;
  EXPECT_NEAR(std::atan(rise) * 180.0 / std::numbers::pi, 80.0, 1e-9);
  EXPECT_EQ(level_at(groove, {45.0 + half_run + 1e-9, 0.0}).height_um, 0.0);
  EXPECT_EQ(level_at(groove, {45.0 - half_run - 1e-9, 0.0}).height_um, -50.0);
  EXPECT_EQ(level_at(groove, {45.0, 0.0}).level, kWall);
  EXPECT_NE(level_at(groove, {0.0, 0.0}).level, level_at(groove, {100.0, 0.0}).level);
  EXPECT_NEAR(wall_run_um(groove), 2.0 * half_run, 1e-12);
}

TEST(Groove, RunsInItsDirection) {
  Groove groove{.width_um = 20.0, .depth_um = 5.0};
  for (const double direction_deg : {0.0, 37.0, 90.0, 200.0}) {
    groove.direction_deg = direction_deg;
    const double cos = std::cos(radians(direction_deg));
    const double sin = std::sin(radians(direction_deg));

    EXPECT_EQ(level_at(groove, {300.0 * cos, 300.0 * sin}).height_um, -5.0) << direction_deg;
    EXPECT_EQ(level_at(groove, {-9.99 * sin, 9.99 * cos}).height_um, -5.0) << direction_deg;
    EXPECT_EQ(level_at(groove, {-10.01 * sin, 10.01 * cos}).height_um, 0.0) << direction_deg;
  }
}

TEST(Stairs, HaveTheirTreadsFromLeftToRight) {
  const Stairs stairs{.treads = {{100.0, 0.0}, {50.0, 30.0}, {70.0, 10.0}}};

  EXPECT_EQ(level_at(stairs, {-500.0, 0.0}).height_um, 0.0);
  EXPECT_EQ(level_at(stairs, {-10.01, 9.0}).height_um, 0.0);
  EXPECT_EQ(level_at(stairs, {-9.99, -9.0}).height_um, 30.0);
  EXPECT_EQ(level_at(stairs, {39.99, 0.0}).height_um, 30.0);
  EXPECT_EQ(level_at(stairs, {40.01, 0.0}).height_um, 10.0);
  EXPECT_EQ(level_at(stairs, {500.0, 0.0}).height_um, 10.0);
  EXPECT_EQ(level_at(stairs, {500.0, 0.0}).level, 2);
}

TEST(Sinusoid, HasItsAmplitudeWavelengthAndPhase) {
  const Sinusoid sinusoid{.amplitude_um = 5.0, .wavelength_um = 120.0, .phase_deg = 90.0, .direction_deg = 90.0};

  EXPECT_NEAR(level_at(sinusoid, {0.0, 77.0}).height_um, 5.0, 1e-12);
  EXPECT_NEAR(level_at(sinusoid, {30.0, 0.0}).height_um, 0.0, 1e-12);
  EXPECT_NEAR(level_at(sinusoid, {60.0, -77.0}).height_um, -5.0, 1e-12);
  EXPECT_NEAR(level_at(sinusoid, {20.0, 0.0}).height_um, 2.5, 1e-12);
  EXPECT_NEAR(level_at({.amplitude_um = 5.0}, {10.0, 0.0}).height_um, 2.5, 1e-12) << "rises to the right";
}

TEST(Star, HasSectorsOfEqualAngleWithinItsRadius) {
  const Star star{.pairs = 18, .height_um = 20.0, .radius_um = 170.0, .direction_deg = 30.0};
  int raised = 0;
  int changes = 0;

  for (int i = 0; i < 36000; ++i) {
    const double angle = radians(0.01 * i + 0.005);
    const double height = level_at(star, {100.0 * std::cos(angle), 100.0 * std::sin(angle)}).height_um;
    const double next =
        level_at(star, {100.0 * std::cos(angle + radians(0.01)), 100.0 * std::sin(angle + radians(0.01))}).height_um;
    raised += height == 20.0 ? 1 : 0;
    changes += height != next ? 1 : 0;
  }

  EXPECT_EQ(raised, 18000);
  EXPECT_EQ(changes, 36);
  const double cos = std::cos(radians(30.0));
  const double sin = std::sin(radians(30.0));
  EXPECT_EQ(level_at(star, {169.9 * cos, 169.9 * sin}).height_um, 20.0);
  EXPECT_EQ(level_at(star, {170.1 * cos, 170.1 * sin}).height_um, 0.0);
}

TEST(CrossGrid, HasItsPitchesAngleAndLines) {
  const CrossGrid grid{.pitch_x_um = 60.0,
                       .pitch_y_um = 40.0,
                       .angle_deg = 80.0,
                       .direction_deg = 10.0,
                       .line_width_um = 12.0,
                       .height_um = 7.0};
  // The first axis lies at 10 degrees from x towards y, the second at 90.
  const auto at = [&](double u, double v) {
    return level_at(grid, {u * std::cos(radians(10.0)), u * std::sin(radians(10.0)) + v}).height_um;
  };

  for (const double column : {-120.0, 0.0, 60.0}) {
    EXPECT_EQ(at(column + 5.99, 20.0), 7.0) << column;
    EXPECT_EQ(at(column - 5.99, 17.0), 7.0) << column;
    EXPECT_EQ(at(column + 6.01, 20.0), 0.0) << column;
    EXPECT_EQ(at(column + 30.0, 20.0), 0.0) << column;
  }
  for (const double row : {-80.0, 0.0, 40.0}) {
    EXPECT_EQ(at(30.0, row + 5.99), 7.0) << row;
    EXPECT_EQ(at(25.0, row - 6.01), 0.0) << row;
  }
}

TEST(LetterF, StandsUprightInTheMiddle) {
  const LetterF letter{.size_um = 250.0, .height_um = 20.0};
  const auto raised = [&](double column, double row) {  // in strokes from the letter's upper left corner
    return level_at(letter, {50.0 * (column - 1.5), 50.0 * (row - 2.5)}).height_um == 20.0;
  };

  const char* const rows[] = {"###", "#..", "##.", "#..", "#.."};
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_EQ(raised(column + 0.5, row + 0.5), rows[row][column] == '#') << row << ", " << column;
    }
  }
  EXPECT_FALSE(raised(-0.01, 0.5));
  EXPECT_FALSE(raised(3.01, 0.5));
  EXPECT_FALSE(raised(0.5, 5.01));
  EXPECT_FALSE(raised(0.5, -0.01));
}

}  // namespace
}  // namespace fvd::sim
