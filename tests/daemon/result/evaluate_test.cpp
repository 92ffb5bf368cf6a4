#include "daemon/result/evaluate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/daemon/export/sample_result.hpp"

namespace fvd {
namespace {

using testing::HasSubstr;

Result evaluated(const ResultData& data) { return evaluate(data, test::summary_of(data.map)); }

std::vector<std::string> codes(const Result& result) {
  std::vector<std::string> codes;
  for (const Warning& warning : result.warnings) codes.push_back(warning.code);
  return codes;
}

TEST(Evaluate, MeasuresHeightsWithWhatTheyRestOn) {
  const Result result = evaluated(test::sample_result());
  const MeasuredValue* const median = result.find("height_median");
  ASSERT_NE(median, nullptr);
  EXPECT_EQ(median->kind, "height");
  EXPECT_EQ(median->unit, "um");
  EXPECT_NEAR(median->value.value(), 13.5, 1e-4);
  EXPECT_EQ(median->points, 16U);
  EXPECT_DOUBLE_EQ(median->valid_fraction, 16.0 / 18.0);
  EXPECT_FALSE(median->limits);
  EXPECT_FALSE(median->verdict);
  EXPECT_EQ(result.find("no_such_value"), nullptr);
}

TEST(Evaluate, WarnsOfSlicesThatMustNotBeBelievedAndOfFlicker) {
  ResultData data = test::sample_result();
  EXPECT_THAT(codes(evaluated(data)), testing::Not(testing::Contains("slices_left_out")));
  data.suspects = {{0, 0.0, SuspectReason::kDark, 0.1, SuspectDone::kTakenAgain},
                   {2, 20.0, SuspectReason::kVibration, 0.6, SuspectDone::kLeftOut}};
  data.flicker_percent = 5.0;
  const Result result = evaluated(data);
  EXPECT_EQ(result.slices.suspect, data.suspects);
  EXPECT_EQ(result.slices.retaken, 1);
  EXPECT_THAT(codes(result), testing::IsSupersetOf({"slices_left_out", "slices_retaken", "light_flicker"}));
  for (const Warning& warning : result.warnings) {
    if (warning.code != "slices_left_out") continue;
    EXPECT_THAT(warning.text, HasSubstr("slice 2 at 20 um"));
  }
}

TEST(Evaluate, WarnsOfConstantsThatWerePastTheirDayWhenThePartWasMeasured) {
  ResultData data = test::sample_result();  // of 2023-11-14
  EXPECT_THAT(codes(evaluated(data)), testing::Not(testing::Contains("calibration_lapsed")));
  data.calibration = test::whole_calibration();
  data.calibration->noise->origin.renew_by = "2023-11-14";
  EXPECT_THAT(codes(evaluated(data)), testing::Not(testing::Contains("calibration_lapsed")));

  data.calibration->z->origin.renew_by = "2023-11-13";
  const Result result = evaluated(data);

  ASSERT_THAT(codes(result), testing::Contains("calibration_lapsed"));
  EXPECT_EQ(result.calibration, data.calibration);
  for (const Warning& warning : result.warnings) {
    if (warning.code != "calibration_lapsed") continue;
    EXPECT_THAT(warning.text, testing::AllOf(HasSubstr("cal-0003 are past"), HasSubstr(": z;")));
  }
}

/// Over a focus curve of 50 um.
ResultData drifting(double x_px_per_um, double scale_per_um) {
  ResultData data = test::sample_result();
  data.map.curve_width_um = 50.0;
  data.drift = DriftFigures{4.0, 0.0, x_px_per_um, 0.0, 0.001, scale_per_um, 1e-6};
  return data;
}

TEST(Evaluate, WarnsOfDriftAndChangeOfScaleOverTheFocusCurve) {
  EXPECT_THAT(codes(evaluated(drifting(0.018, 3e-5))),
              testing::AllOf(testing::Not(testing::Contains("lateral_drift")),
                             testing::Not(testing::Contains("scale_changes"))));
  const Result result = evaluated(drifting(-0.024, -5e-5));
  EXPECT_THAT(codes(result), testing::IsSupersetOf({"lateral_drift", "scale_changes"}));
  EXPECT_NEAR(result.slices.scale_percent.value(), -0.25, 1e-9);
  EXPECT_EQ(result.slices.drift->x_px_per_um, -0.024);
}

TEST(Evaluate, WarnsOfTheDriftThatIsLeftAlone) {
  ResultData data = drifting(0.1, 0.0);
  data.drift_undone = DriftUndone::kRecipe;
  data.drift_undone_x_px_per_um = 0.09;
  EXPECT_THAT(codes(evaluated(data)), testing::Not(testing::Contains("lateral_drift")));
  data.drift_undone_x_px_per_um = 0.0;
  EXPECT_THAT(codes(evaluated(data)), testing::Contains("lateral_drift"));
  data.drift_undone = DriftUndone::kSlices;
  EXPECT_THAT(codes(evaluated(data)), testing::Not(testing::Contains("lateral_drift")));
}

TEST(Evaluate, DoesNotWarnOfADriftThatMayBeNoise) {
  ResultData data = drifting(0.03, 1e-4);
  data.drift->error_px_per_um = 0.011;
  data.drift->scale_error_per_um = 1e-4;
  EXPECT_THAT(codes(evaluated(data)), testing::AllOf(testing::Not(testing::Contains("lateral_drift")),
                                                     testing::Not(testing::Contains("scale_changes"))));
}

TEST(Evaluate, WarnsOfADriftThatVariesFromSliceToSlice) {
  ResultData data = drifting(0.04, 0.0);
  data.drift->error_px_per_um = 0.011;
  EXPECT_THAT(codes(evaluated(data)), testing::Contains("lateral_drift"));
}

TEST(Evaluate, NamesWhatMostHolesAreWhereFewPointsAreValid) {
  ResultData data = test::sample_result();
  data.map = test::sample_map(30, 2);
  for (int x = 1; x < 60; ++x) {
    test::make_hole(data.map, x % 30, x / 30, x < 10 ? mask_reason::kLowProminence : mask_reason::kSaturated);
  }
  const Result result = evaluated(data);
  const auto warning = std::find_if(result.warnings.begin(), result.warnings.end(),
                                    [](const Warning& one) { return one.code == "few_valid_points"; });
  ASSERT_NE(warning, result.warnings.end());
  EXPECT_EQ(warning->text,
            "only 1.7 % of the points are valid; 50 points are at full scale (clipped_share): less "
            "exposure or light");
}

TEST(Evaluate, DoesNotJudgeWhereTheRecipeDoesNot) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 0.0;
  const Result result = evaluated(data);
  EXPECT_FALSE(result.verdict);
  EXPECT_FALSE(result.find("valid_fraction")->verdict);
  EXPECT_FALSE(shortfall(result));
}

TEST(Evaluate, JudgesTheValidFractionAgainstTheRecipe) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 16.0 / 18.0;
  const Result good = evaluated(data);
  EXPECT_EQ(good.verdict, Verdict::kPass);
  EXPECT_EQ(good.find("valid_fraction")->limits, (Limits{16.0 / 18.0, std::nullopt}));
  EXPECT_FALSE(shortfall(good));

  data.min_valid_fraction = 0.9;
  const Result bad = evaluated(data);
  EXPECT_EQ(bad.verdict, Verdict::kFail);
  EXPECT_EQ(bad.find("valid_fraction")->verdict, Verdict::kFail);
}

TEST(Evaluate, SaysThatLightOrTextureIsShort) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 0.9;
  test::make_hole(data.map, 2, 0, mask_reason::kSaturated);
  const auto found = shortfall(evaluated(data));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->code, ErrorCode::kTooFewValid);
  EXPECT_THAT(found->message, HasSubstr("only 83.3333 % of the points are valid, the recipe asks for 90 %"));
  EXPECT_THAT(found->message, HasSubstr("texture"));
}

TEST(Evaluate, SaysThatTheRangeIsShort) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 0.9;
  for (int x = 2; x < 6; ++x) test::make_hole(data.map, x, 0, mask_reason::kLastSlice);
  const auto found = shortfall(evaluated(data));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->code, ErrorCode::kFocusRange);
  EXPECT_THAT(found->message, HasSubstr("the range of 0..20 um"));
}

TEST(Evaluate, WarnsOfMoreSlicesThanPlanned) {
  ResultData data = test::sample_result();
  data.steps[1].measured = true;
  data.slices_planned = 2;
  const Result result = evaluated(data);
  EXPECT_THAT(codes(result), testing::Contains("slices_added"));
  EXPECT_THAT(result.warnings[0].text, HasSubstr("1 slices more than the 2"));
}

TEST(Evaluate, WarnsOfMissingSlicesAndOfARangeThatEndsTooEarly) {
  ResultData data = test::sample_result();
  EXPECT_THAT(codes(evaluated(data)), testing::ElementsAre("slices_missing", "range_first"));
  EXPECT_THAT(evaluated(data).warnings[0].text, HasSubstr("1 of 3 slices"));
  test::make_hole(data.map, 2, 0, mask_reason::kLastSlice);
  data.steps[1].measured = true;
  EXPECT_THAT(codes(evaluated(data)), testing::ElementsAre("range_first", "range_last"));
}

TEST(Evaluate, HasNoWarningForAGoodScan) {
  ResultData data = test::sample_result();
  data.map = test::sample_map();
  data.steps[1].measured = true;
  EXPECT_THAT(codes(evaluated(data)), testing::IsEmpty());
}

TEST(Evaluate, KeepsNamesWithoutValuesWhereEveryPointIsAHole) {
  ResultData data = test::sample_result();
  data.min_valid_fraction = 0.1;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 6; ++x) test::make_hole(data.map, x, y, mask_reason::kLowProminence);
  }
  const Result result = evaluated(data);
  EXPECT_FALSE(result.find("height_mean")->value);
  EXPECT_EQ(result.find("valid_fraction")->value, 0.0);
  EXPECT_EQ(result.verdict, Verdict::kFail);
  EXPECT_THAT(codes(result), testing::Contains("no_valid_point"));
}

}  // namespace
}  // namespace fvd
