/// Evaluations of made surfaces: values, uncertainty, verdicts, reasons.

#include "daemon/evaluation/evaluate_surface.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kWidth = 300;
constexpr int kHeight = 60;

Surface surface_of(const std::function<double(double x_um, double y_um)>& z_um, float sigma_um = 0.2F) {
  Surface surface;
  surface.height_m = Plane<float>(kWidth, kHeight);
  surface.sigma_m = Plane<float>(kWidth, kHeight, sigma_um * 1e-6F);
  surface.pitch_x_um = 1.0;
  surface.pitch_y_um = 1.0;
  surface.kernel.weights.assign(9, 1.0 / 9.0);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      surface.height_m.at(column, row) = static_cast<float>(1e-6 * z_um(column + 0.5, row + 0.5));
    }
  }
  return surface;
}

Surface groove(double depth_um = 50.0) {
  return surface_of([depth_um](double x_um, double y_um) {
    return 100.0 + 0.02 * x_um + 0.01 * y_um - (x_um > 105.0 && x_um < 195.0 ? depth_um : 0.0);
  });
}

/// Slices 10 um apart, each known to 0.01 um.
EvaluationContext slices() {
  EvaluationContext context;
  context.curve_width_um = 28.0;
  for (int i = 0; i < 21; ++i) context.samples.push_back({-7.0 + 10.0 * i, 0.01});
  return context;
}

Evaluation evaluated(const Surface& surface, const std::string& json, const EvaluationContext& context = slices()) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(json, problems);
  EXPECT_THAT(problems, IsEmpty());
  return evaluate_surface(surface, plan, context, nullptr);
}

constexpr const char* kGroove = R"({"measurements": {"step": {"kind": "step_height", "edges_um": [105, 195],
  "limits": {"height_um": {"lower": 49.5, "upper": 50.5}}}}})";

TEST(AnEvaluation, OfAGrooveHasItsDepthWithBudgetAndVerdict) {
  const Evaluation evaluation = evaluated(groove(), kGroove);

  const EvaluatedMeasurement& step = evaluation.measurements.at("step");
  const EvaluatedValue& height = step.values.at("height_um");
  EXPECT_NEAR(height.value.value(), 50.0 / std::sqrt(1.0004), 1e-3);
  EXPECT_NEAR(step.values.at("height_areal_um").value.value(), 50.0 / std::sqrt(1.0005), 1e-3);
  EXPECT_EQ(height.u_method, "linear");
  ASSERT_EQ(height.budget.size(), 2U);
  EXPECT_EQ(height.budget[0].source, "noise");
  EXPECT_GT(height.budget[0].points_as_one.value(), 40.0);
  EXPECT_EQ(height.budget[1].source, "slice_z");
  EXPECT_GT(height.budget[1].u, 0.003);
  EXPECT_LT(height.budget[1].u, 0.02);
  EXPECT_NEAR(height.u.value(), std::hypot(height.budget[0].u, height.budget[1].u), 1e-12);
  EXPECT_NEAR(height.expanded_u.value(), 1.96 * height.u.value(), 1e-3);
  EXPECT_EQ(height.verdict, Verdict::kPass);
  EXPECT_EQ(step.verdict, Verdict::kPass);
  EXPECT_EQ(evaluation.verdict, Verdict::kPass);
  EXPECT_THAT(step.not_evaluated, ElementsAre("alpha_z", "flatness", "l_z", "lead", "repeatability", "temperature"));
  EXPECT_EQ(step.id, "step");
  ASSERT_TRUE(step.cross_section.has_value());
  EXPECT_EQ(step.cross_section->regions.size(), 3U);
}

TEST(AnEvaluation, FailsPassesOrStaysUncertainByTheProbability) {
  const auto verdict_at = [](double lower_um) {
    const std::string text = R"({"measurements": {"step": {"kind": "step_height", "edges_um": [105, 195],
      "limits": {"height_um": {"lower": )" +
                             std::to_string(lower_um) + "}}}}}";
    return evaluated(groove(), text).verdict;
  };

  EXPECT_EQ(verdict_at(49.9), Verdict::kPass);
  EXPECT_EQ(verdict_at(50.1), Verdict::kFail);
  EXPECT_EQ(verdict_at(49.99), Verdict::kUncertain);
}

TEST(AnEvaluation, WithoutStandardErrorsHasNoUAndJudgesNothingButSimply) {
  Surface surface = groove();
  surface.sigma_m = {};

  const Evaluation evaluation = evaluated(surface, kGroove, {});
  const EvaluatedValue& height = evaluation.measurements.at("step").values.at("height_um");
  EXPECT_FALSE(height.u);
  EXPECT_EQ(height.verdict, Verdict::kUncertain);
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Contains("noise"));
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Contains("slice_z"));

  const std::string simple(kGroove);
  const std::string text = simple.substr(0, simple.size() - 1) + R"(, "decision": {"rule": "simple"}})";
  EXPECT_EQ(evaluated(surface, text, {}).verdict, Verdict::kPass);
}

TEST(AnEvaluation, IsInvalidWithAReasonWhereTooFewPointsAreValid) {
  Surface surface = groove();
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 120; column < 180; ++column) surface.height_m.at(column, row) = std::nanf("");
  }

  const Evaluation evaluation = evaluated(surface, kGroove);

  const EvaluatedMeasurement& step = evaluation.measurements.at("step");
  EXPECT_EQ(evaluation.verdict, Verdict::kInvalid);
  EXPECT_THAT(step.reason, Not(IsEmpty()));
  EXPECT_FALSE(step.values.at("height_um").value);
  EXPECT_EQ(step.values.at("height_um").verdict, Verdict::kInvalid);
}

TEST(AnEvaluation, OfRegionsHasTheirStepsAndLevels) {
  const Surface stairs = surface_of([](double x_um, double) { return 10.0 * std::floor(x_um / 100.0); });
  const std::string regions = R"("regions": {
    "a": {"rectangle_um": {"x": 5, "y": 5, "width": 90, "height": 50}},
    "b": {"rectangle_um": {"x": 105, "y": 5, "width": 90, "height": 50}},
    "c": {"rectangle_um": {"x": 205, "y": 5, "width": 90, "height": 50}}})";

  const Evaluation evaluation = evaluated(stairs, "{" + regions + R"(, "measurements": {
    "one": {"kind": "step_between", "lower": "a", "upper": "b"},
    "all": {"kind": "levels", "regions": ["a", "b", "c"]}}})");

  EXPECT_NEAR(evaluation.measurements.at("one").values.at("height_um").value.value(), 10.0, 1e-4);
  const auto& levels = evaluation.measurements.at("all").values;
  EXPECT_NEAR(levels.at("b-a_um").value.value(), 10.0, 1e-4);
  EXPECT_NEAR(levels.at("c-a_um").value.value(), 20.0, 1e-4);
  EXPECT_GT(levels.at("c-a_um").u.value(), 0.0);
}

TEST(AnEvaluation, OfTextureTellsItsConditionsAndUOfEachValueThatHasLimits) {
  const Surface wave = surface_of([](double x_um, double y_um) {
    return 5.0 * std::sin(2.0 * std::numbers::pi * x_um / 50.0) + 0.05 * x_um + 0.02 * y_um;
  });

  const Evaluation evaluation = evaluated(wave, R"({
    "surfaces": {"level": {"steps": [{"op": "level"}]}},
    "measurements": {"t": {"kind": "areal", "surface": "level", "parameters": ["Sa", "Sq", "Str", "Sk"],
      "limits": {"Sa_um": {"upper": 4}, "Sk_um": {"upper": 20}}}}})");

  const EvaluatedMeasurement& texture = evaluation.measurements.at("t");
  EXPECT_NEAR(texture.values.at("Sq_um").value.value(), 5.0 / std::numbers::sqrt2, 0.05);  // a plane takes some of it
  EXPECT_EQ(texture.values.at("Sa_um").u_method, "linear");
  EXPECT_EQ(texture.values.at("Sk_um").u_method, "monte_carlo");
  EXPECT_GT(texture.values.at("Sk_um").u.value(), 0.0);
  EXPECT_FALSE(texture.values.at("Str").value);
  EXPECT_THAT(texture.values.at("Str").reason, Not(IsEmpty()));
  EXPECT_THAT(texture.details, HasSubstr("noise_floor_Sq_um"));
  EXPECT_EQ(evaluation.verdict, Verdict::kPass);
}

TEST(AnEvaluation, OfAFlatSurfaceSaysThatItsTextureIsNoise) {
  const Surface flat = surface_of([](double x_um, double y_um) { return 0.1 * std::sin(17.3 * x_um * y_um); });

  const Evaluation evaluation = evaluated(flat, R"({"measurements": {"t": {"kind": "areal", "parameters": ["Sq"],
    "limits": {"Sq_um": {"lower": 0.01}}}}})");

  EXPECT_EQ(evaluation.verdict, Verdict::kUncertain);
  EXPECT_THAT(evaluation.measurements.at("t").warnings, Contains(Field(&EvaluationWarning::code, "below_noise")));
}

TEST(AnEvaluation, OfAProfileNamesItsSettings) {
  const Surface wave =
      surface_of([](double x_um, double) { return 5.0 * std::sin(2.0 * std::numbers::pi * x_um / 20.0); });

  const Evaluation evaluation = evaluated(wave, R"({"measurements": {"p": {"kind": "profile", "from_um": [5, 30],
    "to_um": [295, 30], "band_width_um": 9, "parameters": ["Ra", "RSm"], "nesting_um": 80, "sections": 3}}})");

  const EvaluatedMeasurement& profile = evaluation.measurements.at("p");
  EXPECT_NEAR(profile.values.at("Ra_um").value.value(), 3.18, 0.1);
  EXPECT_NEAR(profile.values.at("RSm_um").value.value(), 20.0, 0.5);
  EXPECT_EQ(profile.values.at("Ra_um").u_method, "monte_carlo");
  EXPECT_THAT(profile.details, HasSubstr("(0.08 mm x 3)"));
}

TEST(AnEvaluation, IsTheSameWithAnyNumberOfThreads) {
  const Surface surface = groove();
  Problems problems;
  const EvaluationPlan plan = test::read_plan(R"({
    "surfaces": {"s": {"steps": [{"op": "outliers"}, {"op": "level", "fit": "robust"},
                                 {"op": "filter", "side": "S", "nesting_um": 10}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
                                              problems);
  ASSERT_THAT(problems, IsEmpty());
  WorkerPool pool(3);

  EXPECT_EQ(evaluate_surface(surface, plan, slices(), &pool), evaluate_surface(surface, plan, slices(), nullptr));
}

TEST(AnEvaluation, SaysWhyASurfaceCannotBeMade) {
  const Evaluation evaluation = evaluated(groove(), R"({
    "surfaces": {"s": {"steps": [{"op": "filter", "side": "S", "nesting_um": 2}]}},
    "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sa"], "limits": {"Sa_um": {"upper": 1}}}}})");

  EXPECT_EQ(evaluation.verdict, Verdict::kInvalid);
  EXPECT_THAT(evaluation.measurements.at("t").reason, HasSubstr("filter"));
  EXPECT_EQ(evaluation.measurements.at("t").reason_code, evaluation_code::kInvalid);
}

}  // namespace
}  // namespace fvd
