#include "sim/artefact/cutting_edge.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "sim/artefact/parameter_check.hpp"

namespace fvd::sim {
namespace {

/// A trumpet: the rounding is longer on the rake.
CuttingEdge trumpet(double direction_deg) {
  CuttingEdge edge;
  edge.direction_deg = direction_deg;
  edge.rounding = Rounding::kConic;
  edge.s_gamma_um = 40.0;
  edge.s_alpha_um = 20.0;
  return edge;
}

TEST(EdgeSurface, HasItsRakeLeftOfAnEdgeThatRunsDown) {
  const EdgeSurface down(trumpet(90.0), {});
  const EdgeSurface along_x(trumpet(0.0), {});
  const EdgeSurface turned(trumpet(17.0), {});
  const double cos = std::cos(17.0 * std::numbers::pi / 180.0);
  const double sin = std::sin(17.0 * std::numbers::pi / 180.0);

  EXPECT_NEAR(down.height_um({20.0, 3.0}), -20.0, 1e-12) << "clearance flank";
  EXPECT_LT(down.height_um({-20.0, 3.0}), -20.1) << "still the rounding";
  EXPECT_NEAR(along_x.height_um({3.0, -20.0}), -20.0, 1e-12) << "clearance flank";
  EXPECT_LT(along_x.height_um({3.0, 20.0}), -20.1);
  EXPECT_NEAR(turned.height_um({100.0 * cos + 30.0 * sin, 100.0 * sin - 30.0 * cos}), -30.0, 1e-12);
  EXPECT_NEAR(turned.height_um({100.0 * cos, 100.0 * sin}), turned.height_um({0.0, 0.0}), 1e-12);
}

/// Unit normal of the plane through three places.
std::array<double, 3> normal_at(const EdgeSurface& edge, const Place& p) {
  const double h = edge.height_um(p);
  const double a = edge.height_um({p.x_um + 1.0, p.y_um}) - h;
  const double b = edge.height_um({p.x_um, p.y_um + 1.0}) - h;
  const double length = std::hypot(a, b, 1.0);
  return {-a / length, -b / length, 1.0 / length};
}

TEST(EdgeSurface, KeepsItsWedgeAngleWhenTilted) {
  CuttingEdge edge = trumpet(25.0);
  edge.beta_deg = 80.0;
  const EdgeSurface tilted(edge, {.slope_x = 0.3, .slope_y = -0.2});
  const Directed direction(25.0);

  const auto rake = normal_at(tilted, direction.at(10.0, -150.0));
  const auto clearance = normal_at(tilted, direction.at(10.0, 150.0));

  const double cosine = rake[0] * clearance[0] + rake[1] * clearance[1] + rake[2] * clearance[2];
  EXPECT_NEAR(std::acos(cosine) * 180.0 / std::numbers::pi, 180.0 - 80.0, 1e-8);
  const double line = (tilted.height_um(direction.at(50.0, 0.0)) - tilted.height_um(direction.at(-50.0, 0.0))) / 100.0;
  EXPECT_NEAR(line, direction.along(Tilt{0.3, -0.2}), 1e-12) << "the edge lies in the tilted plane";
}

TEST(EdgeSurface, KeepsItsRadiusWhenTilted) {
  CuttingEdge edge;
  edge.radius_um = 10.0;
  edge.direction_deg = 90.0;
  const Tilt tilt{.slope_x = 0.15, .slope_y = 0.4};
  const EdgeSurface tilted(edge, tilt);
  // Turned back: y' = along the edge in space, z' = perpendicular to edge and x.
  const double turn = std::atan(0.4);
  std::array<Place, 3> section{};
  const std::array<double, 3> x{-3.0, 0.5, 4.0};
  for (std::size_t i = 0; i < 3; ++i) {
    section[i] = {x[i], -std::sin(turn) * 7.0 + std::cos(turn) * tilted.height_um({x[i], 7.0})};
  }

  const auto distance = [&](std::size_t i, std::size_t k) {
    return std::hypot(section[i].x_um - section[k].x_um, section[i].y_um - section[k].y_um);
  };
  const double area = (section[1].x_um - section[0].x_um) * (section[2].y_um - section[0].y_um) -
                      (section[2].x_um - section[0].x_um) * (section[1].y_um - section[0].y_um);
  EXPECT_NEAR(distance(0, 1) * distance(1, 2) * distance(2, 0) / (2.0 * std::abs(area)), 10.0, 1e-9);
}

TEST(EdgeSurface, RisesToTheClearanceIfItsTiltDoes) {
  CuttingEdge edge;
  edge.direction_deg = 90.0;
  const EdgeSurface tilted(edge, {.slope_x = 0.1});
  const double turn = std::atan(0.1);

  const double clearance = tilted.height_um({101.0, 0.0}) - tilted.height_um({100.0, 0.0});
  const double rake = tilted.height_um({-100.0, 0.0}) - tilted.height_um({-101.0, 0.0});

  EXPECT_NEAR(clearance, std::tan(-std::numbers::pi / 4.0 + turn), 1e-10);
  EXPECT_NEAR(rake, std::tan(std::numbers::pi / 4.0 + turn), 1e-10);
}

TEST(EdgeSurface, HasTheSameSectionEverywhereAlongABend) {
  for (const double radius_um : {900.0, -900.0}) {
    CuttingEdge edge = trumpet(30.0);
    edge.bend_radius_um = radius_um;
    const EdgeSurface bent(edge, {});

    for (const double along : {-200.0, 0.0, 130.0}) {
      for (const double across : {-60.0, -10.0, 0.0, 5.0, 60.0}) {
        const Place place = bent.place(along, across);
        EXPECT_NEAR(bent.height_um(place), bent.section().height_um(across), 1e-9) << along << ", " << across;
      }
    }
    edge.notches = {{.position_um = 130.0, .width_um = 20.0, .depth_um = 5.0}};
    const EdgeSurface notched(edge, {});
    EXPECT_NEAR(notched.height_um(bent.place(120.0, 0.0)), bent.section().height_um(0.0, 2.5), 1e-9)
        << "half the depth half the width away";
    const double sagitta = Directed(30.0).across(bent.place(200.0, 0.0));
    EXPECT_NEAR(sagitta, radius_um * (1.0 - std::cos(200.0 / 900.0)), 1e-9);
  }
}

TEST(EdgeSurface, HasANotchOfItsDepthWidthAndArea) {
  CuttingEdge edge;
  edge.notches = {{.position_um = 30.0, .width_um = 24.0, .depth_um = 6.0}};
  const EdgeSurface notched(edge, {});
  double area = 0.0;

  for (int i = 0; i < 120000; ++i) area += notched.notch_um(-29.9995 + i * 1e-3) * 1e-3;

  EXPECT_NEAR(notched.notch_um(30.0), 6.0, 1e-12);
  EXPECT_NEAR(notched.notch_um(18.0), 3.0, 1e-12);
  EXPECT_NEAR(notched.notch_um(42.0), 3.0, 1e-12);
  EXPECT_EQ(notched.notch_um(54.0), 0.0);
  EXPECT_EQ(notched.notch_um(5.9), 0.0);
  EXPECT_NEAR(area, 144.0, 1e-3);
  EXPECT_NEAR(notched.height_um({30.0, 0.0}), -notched.section().truth().delta_r_um - 6.0, 1e-12);
  EXPECT_NEAR(notched.height_um({-30.0, 0.0}), -notched.section().truth().delta_r_um, 1e-12);
}

TEST(EdgeSurface, RefusesWhatHasNoTruth) {
  CuttingEdge edge;
  edge.beta_deg = 60.0;
  const auto count = [&](const Tilt& tilt) { return bad_parameters(edge, tilt, 300.0).size(); };
  EXPECT_EQ(count({}), 0U);
  EXPECT_EQ(count({.slope_x = 1.0}), 0U) << "along it";
  EXPECT_EQ(count({.slope_y = 0.5}), 0U) << "26.6 deg of 27";
  EXPECT_EQ(count({.slope_y = -0.52}), 1U) << "a flank overhangs";

  edge.bend_radius_um = -600.0;
  EXPECT_EQ(count({.slope_y = 0.1}), 0U);
  EXPECT_EQ(count({.slope_x = 0.1}), 1U) << "a slope along a bend";
  edge.bend_radius_um = 599.0;
  EXPECT_EQ(count({.slope_x = 0.1, .slope_y = 1.0}), 3U);
}

}  // namespace
}  // namespace fvd::sim
