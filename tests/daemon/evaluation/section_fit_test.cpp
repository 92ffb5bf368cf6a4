/// What was fitted, as lines in pictures of measured heights.

#include "daemon/evaluation/section_fit.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace fvd {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kWidth = 300;
constexpr int kHeight = 60;
constexpr int kWindow = 9;
const metrology::GrooveEdges kEdges{105.0, 195.0};

using HeightAt = std::function<double(double x_um, double y_um)>;

/// A measured surface, and one that is evaluated.
class Surfaces {
 public:
  explicit Surfaces(const HeightAt& measured_um) : Surfaces(measured_um, measured_um) {}
  Surfaces(const HeightAt& measured_um, const HeightAt& evaluated_um) {
    fill(measured_um, measured_.field);
    fill(evaluated_um, evaluated_.field);
  }

  [[nodiscard]] const metrology::HeightField& field() const { return evaluated_.field; }
  [[nodiscard]] SurfaceState& measured() { return measured_; }
  [[nodiscard]] SurfaceState& evaluated() { return evaluated_; }
  [[nodiscard]] PlannedMeasurement& planned() { return planned_; }
  [[nodiscard]] MeasurementInput input() const { return {plan_, planned_, evaluated_, measured_, context_}; }

 private:
  static void fill(const HeightAt& z_um, metrology::HeightField& field) {
    field.z_um = Plane<double>(kWidth, kHeight);
    field.pitch_x_um = field.pitch_y_um = 1.0;
    field.kernel.weights.assign(kWindow, 1.0 / kWindow);
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < kWidth; ++column) field.z_um.at(column, row) = z_um(column + 0.5, row + 0.5);
    }
  }

  EvaluationPlan plan_;
  PlannedMeasurement planned_;
  SurfaceState evaluated_;
  SurfaceState measured_;
  EvaluationContext context_;
};

double tilted(double x_um, double y_um) { return 100.0 + 0.02 * x_um + 0.01 * y_um; }
double groove(double x_um, double y_um) { return tilted(x_um, y_um) - (x_um > 105.0 && x_um < 195.0 ? 50.0 : 0.0); }

CrossSection groove_fit(const Surfaces& surfaces, double slope) {
  CrossSection section = groove_section(surfaces.field(), {}, kEdges);
  add_groove_fit(surfaces.input(), kEdges, slope, section);
  return section;
}

void expect_line(const CrossSection::Curve& line, double from_um, double to_um,
                 const std::function<double(double along_um)>& z_um) {
  ASSERT_THAT(line.along_um, SizeIs(2));
  ASSERT_THAT(line.z_um, SizeIs(2));
  EXPECT_NEAR(line.along_um[0], from_um, 1e-3);
  EXPECT_NEAR(line.along_um[1], to_um, 1e-3);
  EXPECT_NEAR(line.z_um[0], z_um(line.along_um[0]), 2e-3);
  EXPECT_NEAR(line.z_um[1], z_um(line.along_um[1]), 2e-3);
}

void expect_groove(const CrossSection& section) {
  EXPECT_EQ(section.fit_name, "fitted lines");
  ASSERT_THAT(section.fit, SizeIs(2));
  expect_line(section.fit[0], 15.0, 285.0, [](double x_um) { return tilted(x_um, 30.0); });
  expect_line(section.fit[1], 135.0, 165.0, [](double x_um) { return tilted(x_um, 30.0) - 50.0; });
}

TEST(SectionFit, OfAGrooveIsTheLinesThatItsDepthLiesBetween) { expect_groove(groove_fit(Surfaces(groove), 0.02)); }

TEST(SectionFit, OfALevelledSurfaceIsTiltedBackToWhatWasMeasured) {
  const Surfaces levelled(groove,
                          [](double x_um, double y_um) { return groove(x_um, y_um) - tilted(x_um, y_um) + 7.0; });

  expect_groove(groove_fit(levelled, 0.0));
}

TEST(SectionFit, IsInTheHeightsOfTheScansFiles) {
  Surfaces scaled(groove);
  scaled.measured().z_scale = 1.01;

  const CrossSection section = groove_fit(scaled, 0.02);

  ASSERT_THAT(section.fit, SizeIs(2));
  expect_line(section.fit[0], 15.0, 285.0, [](double x_um) { return 1.01 * tilted(x_um, 30.0); });
}

TEST(SectionFit, OfAGrooveGoesOnOverHoles) {
  const auto holed = [](double x_um, double y_um) {
    return x_um > 40.0 && x_um < 60.0 ? std::numeric_limits<double>::quiet_NaN() : groove(x_um, y_um);
  };
  expect_groove(groove_fit(Surfaces(groove, holed), 0.02));
}

TEST(SectionFit, IsNoneWhereNothingIsMeasuredOrPointsHaveOtherPlaces) {
  const auto hole = [](double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_THAT(groove_fit(Surfaces(groove, hole), 0.02).fit, IsEmpty());

  Surfaces cropped(groove);
  cropped.measured().field.z_um = Plane<double>(kWidth + 1, kHeight);
  const CrossSection section = groove_fit(cropped, 0.02);
  EXPECT_THAT(section.fit, IsEmpty());
  EXPECT_TRUE(section.fit_name.empty());
}

TEST(SectionFit, OfARoundedGrooveHasItsBottomsParabola) {
  const auto bottom_um = [](double x_um) {
    return tilted(x_um, 30.0) - 50.0 + (x_um - 150.0) * (x_um - 150.0) / 400.0;
  };
  const Surfaces surfaces([&](double x_um, double y_um) {
    return x_um > 105.0 && x_um < 195.0 ? bottom_um(x_um) + 0.01 * (y_um - 30.0) : tilted(x_um, y_um);
  });
  CrossSection section = groove_section(surfaces.field(), {}, kEdges);

  add_rounded_groove_fit(surfaces.input(), kEdges, 0.02, section);

  ASSERT_THAT(section.fit, SizeIs(2));
  expect_line(section.fit[0], 15.0, 285.0, [](double x_um) { return tilted(x_um, 30.0); });
  const CrossSection::Curve& bottom = section.fit[1];
  EXPECT_NEAR(bottom.along_um.front(), 135.0, 1e-3);
  EXPECT_NEAR(bottom.along_um.back(), 165.0, 1e-3);
  for (std::size_t i = 0; i < bottom.z_um.size(); ++i) {
    EXPECT_NEAR(bottom.z_um[i], bottom_um(bottom.along_um[i]), 2e-3) << i;
  }
}

TEST(SectionFit, OfRegionsIsTheirPlanesWhereTheSectionCrossesThem) {
  const auto stair = [](double x_um, double) { return x_um < 150.0 ? 3.0 : 13.0; };
  const Surfaces levelled([&](double x_um, double y_um) { return tilted(x_um, y_um) + stair(x_um, y_um); }, stair);
  metrology::Region first(kWidth, kHeight);
  metrology::Region second(kWidth, kHeight);
  for (int y = 10; y < 31; ++y) {
    for (int x = 20; x < 120; ++x) first.at(x, y) = second.at(x + 160, y) = 1;
  }
  const std::array regions{SectionRegion{"a", &first}, SectionRegion{"b", &second}};
  CrossSection section = regions_section(levelled.field(), regions);

  const std::array fitted{FittedRegion{regions[0], 3.0}, FittedRegion{regions[1], 13.0}};
  add_plane_fit(levelled.input(), fitted, 0.0, 0.0, section);

  ASSERT_THAT(section.fit, SizeIs(2));
  expect_line(section.fit[0], 20.0, 120.0, [](double x_um) { return tilted(x_um, 20.5) + 3.0; });
  expect_line(section.fit[1], 180.0, 280.0, [](double x_um) { return tilted(x_um, 20.5) + 13.0; });
}

TEST(SectionFit, OfTiltedRegionsHasTheirCommonSlope) {
  const Surfaces surfaces(tilted);
  metrology::Region first(kWidth, kHeight);
  metrology::Region second(kWidth, kHeight);
  for (int y = 10; y < 20; ++y) {
    for (int x = 20; x < 120; ++x) first.at(x, y) = second.at(x + 160, y + 30) = 1;
  }
  const std::array regions{SectionRegion{"a", &first}, SectionRegion{"b", &second}};
  CrossSection section = regions_section(surfaces.field(), regions);

  const std::array fitted{FittedRegion{regions[0], tilted(70.0, 15.0)}, FittedRegion{regions[1], tilted(230.0, 45.0)}};
  add_plane_fit(surfaces.input(), fitted, 0.02, 0.01, section);

  ASSERT_THAT(section.fit, SizeIs(2));
  const double share = 30.0 / std::hypot(160.0, 30.0);
  for (const CrossSection::Curve& line : section.fit) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double y_um = section.from_y_um + share * line.along_um[i];
      const double x_um = section.from_x_um + std::sqrt(1.0 - share * share) * line.along_um[i];
      EXPECT_NEAR(line.z_um[i], tilted(x_um, y_um), 2e-3);
    }
  }
}

constexpr double kApex_um = 150.0;

/// Height over the place of a wedge of 90 degrees: a quarter of an ellipse that leaves the left flank at the distance
/// left_um from the apex and the right one at right_um.
double wedge_um(double x_um, double left_um, double right_um) {
  const double beside_um = x_um - kApex_um;
  const double root = std::sqrt(2.0);
  if (beside_um < -left_um / root || beside_um > right_um / root) return 100.0 - std::abs(beside_um);
  double low = 0.0;
  double high = std::acos(0.0);
  const auto place = [&](double angle, bool height) {
    const double on_left = left_um * (1.0 - std::sin(angle));
    const double on_right = right_um * (1.0 - std::cos(angle));
    return height ? 100.0 - (on_left + on_right) / root : (on_right - on_left) / root;
  };
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2.0;
    (place(middle, false) < beside_um ? low : high) = middle;
  }
  return place(low, true);
}

/// As the window shows it.
HeightAt seen(double left_um, double right_um) {
  return [=](double x_um, double) {
    double sum_um = 0.0;
    for (int i = 0; i < kWindow; ++i) sum_um += wedge_um(x_um + i - kWindow / 2, left_um, right_um);
    return sum_um / kWindow;
  };
}

TEST(SectionFit, OfACuttingEdgeIsItsContourWithoutTheWindow) {
  for (const auto& [left_um, right_um] : {std::pair{20.0, 20.0}, {30.0, 15.0}, {15.0, 30.0}}) {
    for (const auto& [name, side] :
         {std::pair{"left", metrology::RakeSide::kLeft}, {"right", metrology::RakeSide::kRight}}) {
      SCOPED_TRACE(name + (" " + std::to_string(left_um)));
      Surfaces surfaces(seen(left_um, right_um));
      surfaces.planned().rake_side = name;
      surfaces.planned().flank_um = {45.0, 100.0};
      surfaces.planned().sections_every_um = 30.0;
      metrology::EdgeOptions options;
      options.rake_side = side;
      options.sections_every_um = 30.0;
      options.flank_from_um = 45.0;
      options.flank_to_um = 100.0;
      const auto edge = metrology::measure_cutting_edge(surfaces.field(), {}, options);
      CrossSection section = edge_section(edge, surfaces.planned()).value();

      add_edge_fit(surfaces.input(), edge, section);

      EXPECT_EQ(section.fit_name, "model, without the focus window's rounding");
      ASSERT_THAT(section.fit, SizeIs(1));
      const CrossSection::Curve& curve = section.fit.front();
      ASSERT_THAT(curve.along_um, SizeIs(43));
      for (std::size_t i = 0; i < curve.z_um.size(); ++i) {
        EXPECT_NEAR(curve.z_um[i], wedge_um(section.from_x_um + curve.along_um[i], left_um, right_um), 0.3) << i;
      }
    }
  }
}

}  // namespace
}  // namespace fvd
