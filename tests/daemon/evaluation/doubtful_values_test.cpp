/// What an evaluation must not tell: verdicts and uncertainties that rest on less than they seem to.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "daemon/evaluation/evaluate_surface.hpp"
#include "tests/daemon/evaluation/planned.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kWidth = 200;
constexpr int kHeight = 60;
constexpr int kWindow = 9;

Surface surface_of(const std::function<double(double x_um, double y_um)>& z_um, float sigma_um = 0.2F) {
  Surface surface;
  surface.height_m = Plane<float>(kWidth, kHeight);
  surface.sigma_m = Plane<float>(kWidth, kHeight, sigma_um * 1e-6F);
  surface.pitch_x_um = 1.0;
  surface.pitch_y_um = 1.0;
  surface.kernel.weights.assign(kWindow, 1.0 / kWindow);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      surface.height_m.at(column, row) = static_cast<float>(1e-6 * z_um(column + 0.5, row + 0.5));
    }
  }
  return surface;
}

/// A step of 10 um at x = 100 um.
Surface step(float sigma_um = 0.2F) {
  return surface_of([](double x_um, double) { return x_um < 100.0 ? 50.0 : 60.0; }, sigma_um);
}

/// A sharp edge of 90 degrees along y, as the window shows it.
Surface sharp_edge() {
  return surface_of(
      [](double x_um, double) {
        double sum_um = 0.0;
        for (int i = 0; i < kWindow; ++i) sum_um += 100.0 - std::abs(x_um + i - kWindow / 2 - 100.0);
        return sum_um / kWindow;
      },
      0.02F);
}

EvaluationContext slices(double step_um = 10.0) {
  EvaluationContext context;
  context.curve_width_um = 28.0;
  for (int i = 0; i < 21; ++i) context.samples.push_back({-7.0 + step_um * i, 0.01});
  return context;
}

Evaluation evaluated(const Surface& surface, const std::string& json, const EvaluationContext& context = slices()) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(json, problems);
  EXPECT_THAT(problems, IsEmpty());
  return evaluate_surface(surface, plan, context, nullptr);
}

std::string step_between(const std::string& slope = "common_plane", const std::string& surface = "measured") {
  return R"({
    "surfaces": {"flat": {"steps": [{"op": "level", "regions": ["a"]}]}},
    "regions": {"a": {"rectangle_um": {"x": 5, "y": 5, "width": 80, "height": 50}},
                "b": {"rectangle_um": {"x": 115, "y": 5, "width": 80, "height": 50}}},
    "measurements": {"s": {"kind": "step_between", "lower": "a", "upper": "b", "slope": ")" +
         slope + R"(", "surface": ")" + surface + R"(", "limits": {"height_um": {"lower": 5, "upper": 15}}}}})";
}

std::string edge(const std::string& limits, const std::string& more = "") {
  return R"({"measurements": {"e": {"kind": "cutting_edge", "flank_um": [15, 80])" + more +
         R"(, "limits": {"radius_um": )" + limits + "}}}}";
}

auto warning(const std::string& code) { return Contains(Field(&EvaluationWarning::code, code)); }

TEST(ADoubtfulValue, HasNoUOfTheSlicesAloneWhereTheNoiseIsNotKnown) {
  Surface surface = step();
  surface.sigma_m = {};

  const Evaluation evaluation = evaluated(surface, step_between());

  const EvaluatedMeasurement& made = evaluation.measurements.at("s");
  EXPECT_NEAR(made.values.at("height_um").value.value(), 10.0, 1e-3);
  EXPECT_FALSE(made.values.at("height_um").u);
  EXPECT_EQ(evaluation.verdict, Verdict::kUncertain);
  EXPECT_THAT(made.not_evaluated, Contains("noise"));
  EXPECT_THAT(made.not_evaluated, Contains("slice_z"));
}

TEST(ADoubtfulValue, IsGivenWithoutSlicesThatStoodStillOrWentBack) {
  for (const double wrong_um : {0.0, -5.0}) {
    EvaluationContext context = slices();
    context.samples[6].z_um = context.samples[5].z_um + wrong_um;  // where the lower region is

    const Evaluation evaluation = evaluated(step(), step_between(), context);

    const EvaluatedMeasurement& made = evaluation.measurements.at("s");
    EXPECT_TRUE(std::isfinite(made.values.at("height_um").u.value()));
    EXPECT_THAT(made.not_evaluated, Contains("slice_z"));
  }
  EXPECT_THAT(evaluated(step(), step_between(), slices(-10.0)).measurements.at("s").not_evaluated,
              Not(Contains("slice_z")));
}

TEST(ADoubtfulValue, TellsThatTheWindowIsNotKnown) {
  Surface surface = step();
  surface.kernel = {};

  const Evaluation unknown = evaluated(surface, step_between());

  EXPECT_THAT(unknown.measurements.at("s").warnings, warning("window_unknown"));
  EXPECT_THAT(unknown.measurements.at("s").not_evaluated, Contains("correlation"));
  const Evaluation known = evaluated(step(), step_between());
  EXPECT_THAT(known.measurements.at("s").warnings, Not(warning("window_unknown")));
  EXPECT_THAT(known.measurements.at("s").not_evaluated, Not(Contains("correlation")));
}

TEST(ADoubtfulValue, DoesNotRestOnHeightsWithoutStandardErrors) {
  Surface surface = step();
  surface.sigma_m.at(20, 20) = std::nanf("");
  surface.height_m.at(30, 20) = HUGE_VALF;

  const Evaluation evaluation = evaluated(surface, step_between());

  EXPECT_EQ(evaluation.measurements.at("s").points, 2 * 80 * 50 - 2);
  EXPECT_EQ(evaluation.verdict, Verdict::kPass);
}

TEST(ADoubtfulValue, TellsThatALevellingHasErrorsOfItsOwn) {
  const auto not_evaluated = [](const std::string& slope, const std::string& surface) {
    return evaluated(step(), step_between(slope, surface)).measurements.at("s").not_evaluated;
  };

  EXPECT_THAT(not_evaluated("fixed", "flat"), Contains("levelling"));
  EXPECT_THAT(not_evaluated("fixed", "measured"), Not(Contains("levelling")));
  EXPECT_THAT(not_evaluated("common_plane", "flat"), Not(Contains("levelling")));
}

TEST(ADoubtfulValue, OfAnEdgeSharperThanTheWindowIsJudgedByTheBoundAlone) {
  const auto verdict = [](const std::string& limits) { return evaluated(sharp_edge(), edge(limits)).verdict; };

  const EvaluatedMeasurement made = evaluated(sharp_edge(), edge(R"({"upper": 5})")).measurements.at("e");
  ASSERT_THAT(made.warnings, warning("at_most")) << made.reason;
  EXPECT_EQ(made.verdict, Verdict::kPass);
  EXPECT_EQ(verdict(R"({"upper": 4})"), Verdict::kUncertain);
  EXPECT_EQ(verdict(R"({"lower": 4})"), Verdict::kUncertain);
  EXPECT_EQ(verdict(R"({"lower": 0, "upper": 5})"), Verdict::kPass);
  EXPECT_EQ(verdict(R"({"lower": 5})"), Verdict::kFail);
}

TEST(ADoubtfulValue, OfTheDeepestNotchPassesNoUpperLimitWhileANotchIsNotResolved) {
  // A window of 3 um resolves 12 um and does not resolve 4 um.
  const auto made = [](double width_um) {
    Surface notched = surface_of(
        [width_um](double x_um, double y_um) {
          const double wedge_um = 100.0 - std::hypot(x_um - 100.0, 4.0);
          return std::abs(y_um - 30.0) < width_um / 2.0 ? std::min(wedge_um, 90.0) : wedge_um;
        },
        0.02F);
    notched.kernel.weights.assign(3, 1.0 / 3.0);
    return evaluated(notched, R"({"measurements": {"e": {"kind": "cutting_edge", "flank_um": [25, 80],
                       "chipping": {"min_width_um": 2, "max_unmeasured_fraction": 1},
                       "limits": {"chipping_max_um": {"upper": 50}}}}})")
        .measurements.at("e");
  };

  const EvaluatedMeasurement narrow = made(4.0);
  const EvaluatedMeasurement wide = made(12.0);
  ASSERT_GT(narrow.values.at("chipping_max_um").value.value(), 3.0);
  ASSERT_GT(wide.values.at("chipping_max_um").value.value(), 3.0);

  EXPECT_THAT(narrow.warnings, warning("notch_not_resolved"));
  EXPECT_EQ(narrow.verdict, Verdict::kUncertain);
  EXPECT_THAT(wide.warnings, Not(warning("notch_not_resolved")));
  EXPECT_EQ(wide.verdict, Verdict::kPass);
}

TEST(ADoubtfulValue, OfAnEdgeIsRefusedForSectionsBelowThePitch) {
  const Evaluation evaluation = evaluated(sharp_edge(), edge(R"({"upper": 5})", R"(, "sections_every_um": 0.5)"));

  EXPECT_EQ(evaluation.verdict, Verdict::kInvalid);
  EXPECT_THAT(evaluation.measurements.at("e").reason, HasSubstr("below the distance of the points, 1 um"));
}

TEST(ADoubtfulValue, OfAnEdgeIsRefusedWhereTooFewPointsAreValid) {
  Surface surface = sharp_edge();
  for (int row = 0; row < kHeight; row += 3) {
    std::fill_n(surface.height_m.row(row), kWidth, std::nanf(""));
  }

  const auto made = [&surface](const std::string& least) {
    return evaluated(surface, edge(R"({"upper": 5})", R"(, "min_valid_fraction": )" + least)).measurements.at("e");
  };

  EXPECT_THAT(made("0.5").reason, IsEmpty());
  EXPECT_EQ(made("0.8").reason_code, evaluation_code::kTooFewValid);
  EXPECT_EQ(made("0.8").verdict, Verdict::kInvalid);
}

TEST(ADoubtfulValue, OfAProfileBelowTheNoiseDoesNotPassByALowerLimit) {
  const auto profile = [](float sigma_um) {
    const Surface surface = surface_of([](double x_um, double) { return 0.3 * std::sin(0.3 * x_um); }, sigma_um);
    return evaluated(surface, R"({"measurements": {"p": {"kind": "profile", "from_um": [5, 30], "to_um": [195, 30],
      "parameters": ["Ra"], "nesting_um": 30, "limits": {"Ra_um": {"lower": 0.01}}}}})");
  };

  EXPECT_EQ(profile(0.2F).verdict, Verdict::kUncertain);
  EXPECT_THAT(profile(0.2F).measurements.at("p").warnings, warning("below_noise"));
  EXPECT_EQ(profile(0.01F).verdict, Verdict::kPass);
}

TEST(ADoubtfulValue, OfAProfileThatLeavesTheFieldOrIsTooShortSaysSo) {
  const auto made = [](const std::string& to, const std::string& nesting) {
    return evaluated(step(), R"({"measurements": {"p": {"kind": "profile", "from_um": [5, 30], "to_um": )" + to +
                                 R"(, "parameters": ["Ra"], "nesting_um": )" + nesting + "}}}")
        .measurements.at("p");
  };

  EXPECT_EQ(made("[205, 30]", "20").reason_code, evaluation_code::kRegionOutside);
  EXPECT_EQ(made("[5.5, 30]", "20").reason_code, evaluation_code::kInvalid);
  EXPECT_EQ(made("[195, 30]", "80").reason_code, evaluation_code::kInvalid);
  EXPECT_THAT(made("[195, 30]", "80").reason, HasSubstr("does not hold the evaluation length"));
}

TEST(ADoubtfulValue, OfASurfaceMadeFromOneThatCannotBeMadeReadsBackWithTheSteps) {
  Evaluation evaluation = evaluated(step(), R"({
    "surfaces": {"s": {"steps": [{"op": "filter", "side": "S", "nesting_um": 2}]}, "t": {"from": "s"}},
    "measurements": {"x": {"kind": "areal", "surface": "t", "parameters": ["Sa"]}}})");

  const std::string text = fields_to_json([&](Fields& fields) { describe(evaluation, fields); }).dump();
  Evaluation read;
  Problems problems;
  read_document(
      text, [&read](Fields& fields) { describe(read, fields); }, problems);

  EXPECT_THAT(problems, IsEmpty());
  EXPECT_THAT(read.surfaces.at("t"), HasSubstr("refused"));
}

}  // namespace
}  // namespace fvd
