#include "core/metrology/edge/section_data.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "core/metrology/edge/window_profile.hpp"

namespace fvd::metrology::edge {
namespace {

// An edge along y that climbs by 0.5 um for each um, between flanks of 45 degrees in the section.
HeightField steep_edge() {
  HeightField field;
  field.z_um = Plane<double>(120, 200);
  for (int row = 0; row < 200; ++row) {
    for (int column = 0; column < 120; ++column) {
      const double away = std::abs(field.x_um(column) - 60.0);
      field.z_um.at(column, row) = 0.5 * field.y_um(row) - std::sqrt(1.25) * away;
    }
  }
  return field;
}

StraightEdge line_of_steep_edge() {
  StraightEdge line;
  line.origin_x_um = 60.0;
  line.origin_y_um = 100.0;
  line.origin_z_um = 50.0;
  line.tilt = 0.5;
  return line;
}

TEST(EdgeFrame, SpansAPlaneAtRightAnglesToTheEdgeInSpace) {
  const HeightField field = steep_edge();
  const EdgeCurve curve(line_of_steep_edge(), field, {});
  const EdgeFrame frame = curve.frame(10.0);

  const SpacePoint point = frame.at(7.0, -20.0);

  const double along =
      (point.x - frame.x) * frame.e_x + (point.y - frame.y) * frame.e_y + (point.z - frame.z) * frame.tilt;
  EXPECT_NEAR(along, 0.0, 1e-9);
  EXPECT_NEAR(std::hypot(std::hypot(point.x - frame.x, point.y - frame.y), point.z - frame.z), std::hypot(7.0, 20.0),
              1e-9);
  EXPECT_NEAR(curve.whole_length_um(), 200.0 * std::sqrt(1.25), 1e-3);
}

TEST(Sections, HoldThePointsOfThePlaneAtRightAnglesToTheEdge) {
  const HeightField field = steep_edge();
  const EdgeCurve curve(line_of_steep_edge(), field, {});
  EdgeOptions options;
  options.flank_to_um = 50.0;

  const std::vector<SectionData> sections = cut_sections(field, {}, curve, options);

  const SectionData& section = sections.at(11);
  ASSERT_FALSE(section.points.empty());
  for (const SectionPoint& p : section.points) {
    const double along = ((field.y_um(p.row) - section.frame.y) * section.frame.e_y +
                          (field.z_um.at(p.column, p.row) - section.frame.z) * section.frame.tilt) /
                         section.frame.stretch;
    EXPECT_LE(std::abs(along), 5.01);
  }
  for (std::size_t i = 0; i < section.s_um.size(); ++i) {
    EXPECT_NEAR(section.h_um[i], -std::abs(section.s_um[i]), 1e-9);
  }
}

TEST(WindowProfile, KnowsPixelsThatAreNotSquare) {
  LateralKernel kernel;
  kernel.weights.assign(3, 1.0 / 3.0);

  const WindowProfile along_x(kernel, 1.0, 2.0, 1.0, 0.0);
  const WindowProfile along_y(kernel, 1.0, 2.0, 0.0, 1.0);

  EXPECT_NEAR(along_x.width_um(), 3.0, 1e-6);
  EXPECT_NEAR(along_y.width_um(), 6.0, 1e-6);
  EXPECT_NEAR(along_y.mean_distance_um(0.0), 1.5, 1e-9);
}

}  // namespace
}  // namespace fvd::metrology::edge
