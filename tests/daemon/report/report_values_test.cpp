#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/report/condition_lines.hpp"
#include "daemon/report/scalar_image.hpp"
#include "daemon/report/section_points.hpp"
#include "daemon/report/value_rows.hpp"
#include "tests/daemon/report/sample_report.hpp"

namespace fvd {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> names_of(const std::vector<ValueRow>& rows) {
  std::vector<std::string> names;
  for (const ValueRow& row : rows) names.push_back(row.measurement + "/" + row.name);
  return names;
}

TEST(ValueRows, BeginWithTheMainValueAndFollowTheRecipesOrder) {
  Result result = test::sample_report_result();
  EvaluatedMeasurement& land = result.evaluation->measurements["land"];
  land.main_value = "Str";
  land.values["Sq_um"] = test::value_of(1.0, "um", 0.1);
  land.values["Sq_um"].limits = Limits{{}, 2.0};
  MeasuredValue valid;
  valid.name = "valid_fraction";
  valid.unit = "1";
  valid.limits = Limits{0.5, {}};
  MeasuredValue mean;
  mean.name = "height_mean";
  result.measurements = {mean, valid};

  EXPECT_THAT(names_of(value_rows(result)),
              ElementsAre("step/height", "/height_areal", "land/Str", "/Sq", "/Sa", "map/valid_fraction"));
  result.evaluation.reset();
  EXPECT_THAT(names_of(value_rows(result)), ElementsAre("map/height_mean", "/valid_fraction"));
}

TEST(ValueRows, HaveNoMoreDigitsThanTheyAreSureOf) {
  Result result = test::sample_report_result();
  EvaluatedValue& height = result.evaluation->measurements["step"].values["height_um"];

  EXPECT_EQ(value_rows(result)[0].value, "49.985");
  EXPECT_EQ(value_rows(result)[0].uncertainty, "0.048  (k 2.00)");
  height.expanded_u = 0.5;
  EXPECT_EQ(value_rows(result)[0].value, "49.99");
  height.expanded_u.reset();
  EXPECT_EQ(value_rows(result)[0].value, "49.9851");
  EXPECT_EQ(value_rows(result)[0].uncertainty, "-");
  height.limits = Limits{49.5, {}};
  EXPECT_EQ(value_rows(result)[0].limits, "≥ 49.5");
}

TEST(ValueRows, NameAMeasurementWithoutValuesWithItsReason) {
  Result result = test::sample_report_result();
  EvaluatedMeasurement& step = result.evaluation->measurements["step"];
  step.values.clear();
  step.reason = "no groove";
  step.verdict = Verdict::kInvalid;

  const ValueRow row = value_rows(result).front();

  EXPECT_EQ(row.measurement, "step");
  EXPECT_EQ(row.reason, "no groove");
  EXPECT_EQ(row.verdict, Verdict::kInvalid);
}

TEST(ValueRows, NeverSayABareRaForOtherThanTheDefaultSettings) {
  Result result = test::sample_report_result();
  EvaluatedMeasurement profile;
  profile.kind = "profile";
  profile.details = R"json({"label_suffix": " (0.08 mm x 5)"})json";
  profile.values["Ra_um"] = test::value_of(0.4, "um", 0.1);
  profile.values["Pa_um"] = test::value_of(0.4, "um", 0.1);
  result.evaluation->order = {"trace"};
  result.evaluation->measurements = {{"trace", profile}};

  EXPECT_THAT(names_of(value_rows(result)), ElementsAre("trace/Pa", "/Ra (0.08 mm x 5)"));
}

TEST(UnitText, IsForPeople) {
  EXPECT_EQ(unit_text("um"), "µm");
  EXPECT_EQ(unit_text("um^2"), "µm²");
  EXPECT_EQ(unit_text("ml/m^2"), "ml/m²");
  EXPECT_EQ(unit_text("deg"), "°");
  EXPECT_EQ(unit_text("%"), "%");
  EXPECT_EQ(unit_text("1"), "");
  EXPECT_EQ(unit_text("um/um"), "");
}

TEST(WithMicroSign, ReplacesTheUnitBehindNumbersOnly) {
  EXPECT_EQ(with_micro_sign("0.135 um is below 0.1 um"), "0.135 µm is below 0.1 µm");
  EXPECT_EQ(with_micro_sign("3 umbrellas, the um, 2 um_x"), "3 umbrellas, the um, 2 um_x");
  EXPECT_EQ(with_micro_sign(" um"), " um");
}

TEST(ConditionLines, TellTheSameOfASurfaceWhoseKeysAreInAnotherOrder) {
  Result result = test::sample_report_result();
  std::string& steps = result.evaluation->surfaces["texture"];
  steps = R"([{"op":"filter","side":"S","nesting_um":80.5,"did":{"points_used":44800}}])";
  const std::string words = condition_lines(result)[2].text;

  steps = R"([{"did":{"points_used":44800},"nesting_um":80.5,"side":"S","op":"filter"}])";

  EXPECT_EQ(condition_lines(result)[2].text, words);
  EXPECT_EQ(words, "filter (nesting 80.5 µm, side S): 44800 points used");
}

TEST(ConditionLines, SayWhyAValueIsNotThere) {
  const auto lines = condition_lines(test::sample_report_result());

  ASSERT_GE(lines.size(), 2U);
  EXPECT_EQ(lines[1].about, "land");
  EXPECT_THAT(lines[1].text, HasSubstr("no Str: the autocorrelation does not fall"));
}

TEST(ConditionLines, DoNotCallAPointLessAll) {
  Result result = test::sample_report_result();
  result.evaluation->measurements["step"].valid_fraction = 0.99999;
  EXPECT_THAT(condition_lines(result).front().text, HasSubstr("99.9 % valid"));

  result.evaluation->measurements["step"].valid_fraction = 1.0;

  EXPECT_THAT(condition_lines(result).front().text, HasSubstr("100.0 % valid"));
}

TEST(SectionPoints, AreMeansAcrossTheBandAndHolesWhereHalfIsMissing) {
  Surface surface = test::groove_surface(8, 6, 2.0);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) surface.height_m.at(x, y) = static_cast<float>((10 * x + y) * 1e-6);
  }
  for (int y = 0; y < 3; ++y) surface.height_m.at(5, y) = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < 4; ++y) surface.height_m.at(6, y) = std::numeric_limits<float>::quiet_NaN();

  const auto points = section_points(picture_surface(surface), {0.0, 6.0, 20.0, 6.0, 12.0, {}});

  ASSERT_EQ(points.size(), 10U);
  EXPECT_DOUBLE_EQ(points[0].along_um, 1.0);
  EXPECT_NEAR(points[0].height_um, 2.5, 1e-5);
  EXPECT_NEAR(points[4].height_um, 42.5, 1e-5);
  EXPECT_NEAR(points[5].height_um, 54.0, 1e-5) << "the mean of those that are valid";
  EXPECT_TRUE(std::isnan(points[6].height_um));
  EXPECT_TRUE(std::isnan(points[8].height_um)) << "outside";
}

TEST(SectionPoints, FollowALineDownwards) {
  Surface surface = test::groove_surface(8, 6, 2.0);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) surface.height_m.at(x, y) = static_cast<float>((10 * x + y) * 1e-6);
  }

  const auto points = section_points(picture_surface(surface), {5.0, 12.0, 5.0, 0.0, 0.0, {}});

  ASSERT_EQ(points.size(), 6U);
  EXPECT_NEAR(points.front().height_um, 25.0, 1e-5) << "upwards from the last row";
  EXPECT_NEAR(points.back().height_um, 20.0, 1e-5);
}

TEST(SectionPoints, LookSquarelyAcrossAnObliqueLine) {
  Surface surface = test::groove_surface(60, 60, 1.0);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) surface.height_m.at(x, y) = static_cast<float>((x - y) * (x - y) * 1e-6);
  }

  const auto points = section_points(picture_surface(surface), {20.0, 20.0, 40.0, 40.0, 12.0, {}});

  // The mean of (sqrt(2) b)^2 over b from -6 to 6 is 24; along the line it would be 0.
  for (const SectionPoint& point : points) EXPECT_NEAR(point.height_um, 24.0, 6.0);
}

TEST(ScalarImage, IsTheMeanOfTheValidPointsOfABlock) {
  Plane<float> metres(5, 4, 2e-6F);
  metres.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
  metres.at(1, 0) = 5e-6F;
  metres.at(2, 0) = metres.at(3, 0) = metres.at(2, 1) = std::numeric_limits<float>::quiet_NaN();

  const ScalarImage image = shrunk_um(metres.view(), 3);

  ASSERT_EQ(image.width, 3);
  ASSERT_EQ(image.height, 2);
  EXPECT_NEAR(image.at(0, 0), 3.0F, 1e-5F);
  EXPECT_TRUE(std::isnan(image.at(1, 0))) << "one valid point of four";
  EXPECT_NEAR(image.at(2, 1), 2.0F, 1e-5F) << "the border's block has two points";
}

TEST(RobustRange, LeavesOutSpikesAndIsNeverEmpty) {
  ScalarImage image{1000, 1, {}};
  for (int i = 0; i < 1000; ++i) image.values.push_back(static_cast<float>(i));
  image.values[999] = 1e6F;
  const ValueRange range = robust_range(image, 0.005);
  EXPECT_DOUBLE_EQ(range.low, 5.0);
  EXPECT_DOUBLE_EQ(range.high, 994.0);

  const ValueRange flat = robust_range({2, 1, {7.0F, 7.0F}}, 0.005);

  EXPECT_LT(flat.low, 7.0);
  EXPECT_GT(flat.high, 7.0);
  EXPECT_TRUE(flat.any);
  EXPECT_FALSE(robust_range({1, 1, {std::numeric_limits<float>::quiet_NaN()}}, 0.005).any);
}

}  // namespace
}  // namespace fvd
