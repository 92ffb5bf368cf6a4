/// Heights of tilted parts, values of invalid measurements, and verdicts on noise.

#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include "daemon/evaluation/evaluate_surface.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;

Surface surface_of(const std::function<double(double x_um, double y_um)>& z_um) {
  Surface surface;
  surface.height_m = Plane<float>(300, 60);
  surface.sigma_m = Plane<float>(300, 60, 0.2e-6F);
  surface.pitch_x_um = 1.0;
  surface.pitch_y_um = 1.0;
  surface.kernel.weights.assign(9, 1.0 / 9.0);
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 300; ++column) {
      surface.height_m.at(column, row) = static_cast<float>(1e-6 * z_um(column + 0.5, row + 0.5));
    }
  }
  return surface;
}

Surface groove(double slope_x, double slope_y) {
  return surface_of([=](double x_um, double y_um) {
    return 100.0 + slope_x * x_um + slope_y * y_um - (x_um > 105.0 && x_um < 195.0 ? 50.0 : 0.0);
  });
}

Evaluation evaluated(const Surface& surface, const std::string& json) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(json, problems);
  EXPECT_THAT(problems, IsEmpty());
  return evaluate_surface(surface, plan, {}, nullptr);
}

TEST(AGrooveTiltedAlongItself, IsNotJudgedByItsTraces) {
  const Evaluation evaluation = evaluated(groove(0.0, 0.2), R"({"measurements": {"step": {"kind": "step_height",
    "edges_um": [105, 195], "limits": {"height_um": {"lower": 49.5, "upper": 50.5}}}}})");

  const EvaluatedMeasurement& step = evaluation.measurements.at("step");
  EXPECT_NEAR(step.values.at("height_um").value.value(), 50.0, 1e-3);
  EXPECT_NEAR(step.values.at("height_areal_um").value.value(), 50.0 / std::sqrt(1.04), 1e-3);
  EXPECT_EQ(step.values.at("height_um").verdict, Verdict::kUncertain);
  EXPECT_THAT(step.warnings, Contains(Field(&EvaluationWarning::code, "tilt_along")));
}

TEST(AStep, IsPerpendicularToTheSurfaceThatWasLevelled) {
  const std::string plan = R"({"surfaces": {"level": {"steps": [{"op": "level", "regions": ["land"]}]}},
    "regions": {"land": {"rectangle_um": {"x": 5, "y": 5, "width": 90, "height": 50}},
                "floor": {"rectangle_um": {"x": 120, "y": 5, "width": 60, "height": 50}}},
    "measurements": {"a": {"kind": "step_height", "surface": "level", "edges_um": [105, 195]},
                     "b": {"kind": "step_between", "surface": "level", "lower": "floor", "upper": "land", "slope": "fixed"}}})";

  const Evaluation evaluation = evaluated(groove(0.15, 0.1), plan);

  const double expected_um = 50.0 / std::sqrt(1.0 + 0.15 * 0.15 + 0.1 * 0.1);
  EXPECT_NEAR(evaluation.measurements.at("a").values.at("height_areal_um").value.value(), expected_um, 2e-3);
  EXPECT_NEAR(evaluation.measurements.at("b").values.at("height_um").value.value(), expected_um, 2e-3);
}

TEST(AnInvalidMeasurement, HasNoValuesAndNoVerdictThatNobodyAskedFor) {
  Surface surface = groove(0.0, 0.0);
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 200; ++column) surface.height_m.at(column, row) = std::nanf("");
  }

  const Evaluation evaluation =
      evaluated(surface, R"({"measurements": {"t": {"kind": "areal", "parameters": ["Sa"]}}})");

  const EvaluatedMeasurement& texture = evaluation.measurements.at("t");
  EXPECT_FALSE(evaluation.verdict);
  EXPECT_FALSE(texture.values.at("Sa_um").value);
  EXPECT_THAT(texture.values.at("Sa_um").reason, Not(IsEmpty()));
  EXPECT_EQ(texture.reason_code, evaluation_code::kTooFewValid);
}

TEST(ATextureBelowItsNoise, CannotFailByAnUpperLimit) {
  const Surface flat = surface_of([](double x_um, double y_um) { return 0.15 * std::sin(17.3 * x_um * y_um); });

  const Evaluation evaluation = evaluated(flat, R"({"measurements": {"t": {"kind": "areal", "parameters": ["Sa"],
    "limits": {"Sa_um": {"upper": 0.02}}}}})");

  EXPECT_EQ(evaluation.verdict, Verdict::kUncertain);
}

}  // namespace
}  // namespace fvd
