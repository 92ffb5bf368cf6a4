/// What was fitted, as lines in pictures of measured heights.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kWidth = 300;
constexpr int kHeight = 60;
constexpr int kWindow = 9;

Surface surface_of(const std::function<double(double x_um, double y_um)>& z_um) {
  Surface surface;
  surface.height_m = Plane<float>(kWidth, kHeight);
  surface.sigma_m = Plane<float>(kWidth, kHeight, 0.02e-6F);
  surface.pitch_x_um = surface.pitch_y_um = 1.0;
  surface.kernel.weights.assign(kWindow, 1.0 / kWindow);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      surface.height_m.at(column, row) = static_cast<float>(1e-6 * z_um(column + 0.5, row + 0.5));
    }
  }
  return surface;
}

CrossSection section_of(const Surface& surface, const std::string& json) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(json, problems);
  EXPECT_THAT(problems, IsEmpty());
  EvaluationContext context;
  context.curve_width_um = 28.0;
  const Evaluation evaluation = evaluate_surface(surface, plan, context, nullptr);
  return evaluation.measurements.at("m").cross_section.value();
}

double tilted(double x_um, double y_um) { return 100.0 + 0.02 * x_um + 0.01 * y_um; }

Surface groove() {
  return surface_of(
      [](double x_um, double y_um) { return tilted(x_um, y_um) - (x_um > 105.0 && x_um < 195.0 ? 50.0 : 0.0); });
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

TEST(SectionFit, OfAGrooveIsTheLinesThatItsDepthLiesBetween) {
  for (const std::string surface : {"measured", "flat"}) {
    SCOPED_TRACE(surface);
    const CrossSection section = section_of(groove(), R"({
      "surfaces": {"flat": {"steps": [{"op": "level", "regions": ["land"]}, {"op": "shift_z", "by_um": 7}]}},
      "regions": {"land": {"rectangle_um": {"x": 5, "y": 5, "width": 80, "height": 50}}},
      "measurements": {"m": {"kind": "step_height", "edges_um": [105, 195], "surface": ")" +
                                                          surface + "\"}}}");

    EXPECT_EQ(section.fit_name, "fitted lines");
    ASSERT_THAT(section.fit, SizeIs(2));
    expect_line(section.fit[0], 15.0, 285.0, [](double x_um) { return tilted(x_um, 30.0); });
    expect_line(section.fit[1], 135.0, 165.0, [](double x_um) { return tilted(x_um, 30.0) - 50.0; });
  }
}

TEST(SectionFit, OfAGrooveGoesOnOverHoles) {
  Surface surface = groove();
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 40; column < 60; ++column) {
      surface.height_m.at(column, row) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const CrossSection section =
      section_of(surface, R"({"measurements": {"m": {"kind": "step_height", "edges_um": [105, 195],
                             "min_valid_fraction": 0.3}}})");

  ASSERT_THAT(section.fit, SizeIs(2));
  expect_line(section.fit[0], 15.0, 285.0, [](double x_um) { return tilted(x_um, 30.0); });
}

TEST(SectionFit, OfARoundedGrooveHasItsBottomsParabola) {
  const auto bottom_um = [](double x_um) {
    return tilted(x_um, 30.0) - 50.0 + (x_um - 150.0) * (x_um - 150.0) / 400.0;
  };
  const Surface rounded = surface_of([&](double x_um, double y_um) {
    return x_um > 105.0 && x_um < 195.0 ? bottom_um(x_um) + 0.01 * (y_um - 30.0) : tilted(x_um, y_um);
  });

  const CrossSection section = section_of(
      rounded, R"({"measurements": {"m": {"kind": "step_height", "method": "iso5436_a2", "edges_um": [105, 195]}}})");

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
  const Surface step =
      surface_of([](double x_um, double y_um) { return tilted(x_um, y_um) + (x_um < 150.0 ? 0.0 : 10.0); });
  for (const std::string kind :
       {R"("kind": "step_between", "lower": "a", "upper": "b")", R"("kind": "levels", "regions": ["a", "b"])"}) {
    SCOPED_TRACE(kind);
    const CrossSection section = section_of(step, R"({
      "regions": {"a": {"rectangle_um": {"x": 20, "y": 10, "width": 100, "height": 20}},
                  "b": {"rectangle_um": {"x": 180, "y": 10, "width": 100, "height": 20}}},
      "measurements": {"m": {)" + kind + "}}}");

    ASSERT_THAT(section.fit, SizeIs(2));
    expect_line(section.fit[0], 20.0, 120.0, [](double x_um) { return tilted(x_um, 20.0); });
    expect_line(section.fit[1], 180.0, 280.0, [](double x_um) { return tilted(x_um, 20.0) + 10.0; });
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
Surface edge(double left_um, double right_um) {
  return surface_of([=](double x_um, double) {
    double sum_um = 0.0;
    for (int i = 0; i < kWindow; ++i) sum_um += wedge_um(x_um + i - kWindow / 2, left_um, right_um);
    return sum_um / kWindow;
  });
}

TEST(SectionFit, OfACuttingEdgeIsItsContourWithoutTheWindow) {
  for (const auto& [left_um, right_um] : {std::pair{20.0, 20.0}, {30.0, 15.0}, {15.0, 30.0}}) {
    for (const std::string rake_side : {"left", "right"}) {
      SCOPED_TRACE(rake_side + " " + std::to_string(left_um));
      const CrossSection section =
          section_of(edge(left_um, right_um), R"({"measurements": {"m": {"kind": "cutting_edge", "flank_um": [45, 100],
                     "rake_side": ")" + rake_side +
                                                  "\"}}}");

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

TEST(SectionFit, IsNoneWhereNothingIsFitted) {
  Surface surface = groove();
  const CrossSection whole =
      section_of(surface, R"({"measurements": {"m": {"kind": "profile", "from_um": [10, 30], "to_um": [200, 30],
                             "band_width_um": 9, "parameters": ["Pa"]}}})");

  EXPECT_THAT(whole.fit, IsEmpty()) << "a profile fits nothing";
  EXPECT_TRUE(whole.fit_name.empty());
}

}  // namespace
}  // namespace fvd
