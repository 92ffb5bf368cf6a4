#include "core/stage/stage_report.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/stage/quantile.hpp"
#include "tests/core/stage/synthetic_stage.hpp"

namespace fvd {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(StageReport, GivesTheFiguresOfAStageWithKnownFaults) {
  const test::SyntheticStage stage;
  const StageReport report = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_EQ(report.n, 366);
  EXPECT_TRUE(report.observable);
  ASSERT_TRUE(report.reversal && report.repeatability && report.fit && report.linear);
  EXPECT_EQ(report.reversal->positions, 61);
  EXPECT_NEAR(report.reversal->mean_um, 0.8, 0.01);
  EXPECT_NEAR(report.reversal->max_um, 0.8, 0.08) << "the largest of 61 noisy means";
  EXPECT_EQ(report.repeatability->groups, 122);
  EXPECT_NEAR(report.repeatability->pooled_sd_um, 0.02, 0.002) << "without the drift, which is 0.4 um over the runs";
  EXPECT_LT(report.repeatability->max_sd_um, 0.07);
  EXPECT_NEAR(report.fit->alpha_z->value, 1.0004, 5e-5);
  // The planted sine and what the three leads leave of its bias.
  EXPECT_NEAR(report.linear->alpha_z.value, 1.0004, 7e-5);
  EXPECT_NEAR(report.linear->l_z_um, 0.3, 0.12);
  EXPECT_GT(report.linear->residual_rms_um, 0.4) << "drift, reversal and lead error are in it";
  EXPECT_NEAR(report.step_quantum_floor_um.value(), 0.01 / std::sqrt(12.0), 1e-12);
  EXPECT_NEAR(report.settle->p50_ms, 24.0, 1.0);
  EXPECT_EQ(report.settle->max_ms, 29.0);
  EXPECT_EQ(report.move->max_ms, 69.0);
  EXPECT_NEAR(report.duration_min.value(), 365 * 0.8 / 60, 1e-9);
}

TEST(StageReport, ErrorFiguresAreThoseOfTheDefinition) {
  std::vector<StagePoint> points(4);
  const double measured[] = {1.0, 12.0, 19.0, 34.0};  // errors 1, 2, -1, 4; increments 1, -3, 5
  for (int i = 0; i < 4; ++i) {
    points[static_cast<std::size_t>(i)].time_s = i;
    points[static_cast<std::size_t>(i)].commanded_um = 10.0 * i + 0.5;
    points[static_cast<std::size_t>(i)].quantised_um = 10.0 * i;
    points[static_cast<std::size_t>(i)].measured_um = measured[i];
  }
  const StageReport report = make_stage_report(points, {FeedbackSource::kLinearScale, 1.0, 0.0, {}});
  EXPECT_DOUBLE_EQ(report.error->mean_um, 1.5);
  EXPECT_NEAR(report.error->sd_um.value(), std::sqrt(13.0 / 3.0), 1e-12);
  EXPECT_DOUBLE_EQ(report.error->max_um, 4.0);
  EXPECT_DOUBLE_EQ(report.error->p95_um, 3.7);  // of 1 1 2 4
  EXPECT_DOUBLE_EQ(report.error_to_command->mean_um, 1.0);
  EXPECT_DOUBLE_EQ(report.quantisation->mean_um, -0.5);
  EXPECT_DOUBLE_EQ(report.increment_error->mean_um, 1.0);
  EXPECT_DOUBLE_EQ(report.increment_error->max_um, 5.0);
  EXPECT_FALSE(report.feedback_resolution_um) << "0 means unknown";
  EXPECT_FALSE(report.feedback_floor_um);

  points[2].run = points[3].run = 1;  // the move between the runs is not a step
  EXPECT_DOUBLE_EQ(make_stage_report(points, {FeedbackSource::kLinearScale, 1.0, 0.0, {}}).increment_error->mean_um,
                   3.0);
  points[3].direction = -1;
  EXPECT_DOUBLE_EQ(make_stage_report(points, {FeedbackSource::kLinearScale, 1.0, 0.0, {}}).increment_error->mean_um,
                   1.0);
}

TEST(StageReport, StraightLineOverOneLeadIsBiasedAndSaysSo) {
  test::SyntheticStage stage;
  stage.start_um = 0.0;
  stage.range_um = 1000.0;
  stage.alpha_z = 1.0;
  stage.phase_deg = 0.0;
  stage.positions = 201;
  stage.runs = 4;
  const StageReport report = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_NEAR(report.linear->alpha_z.value, 0.99943, 3e-5) << "-6 A / (pi lead)";
  EXPECT_NEAR(report.fit->alpha_z->value, 1.0, 2e-5);
  EXPECT_NEAR(report.linear->alpha_z_bias_bound.value(), 5.73e-4, 2e-5);
  EXPECT_THAT(report.caveats, Contains(HasSubstr("shorter than three screw leads")));

  stage.range_um = 900.0;
  const StageReport less = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_FALSE(less.fit->lead);
  EXPECT_FALSE(less.linear->alpha_z_bias_bound);
  EXPECT_THAT(less.caveats, Contains(HasSubstr("shorter than one screw lead")));
}

TEST(StageReport, WithoutFeedbackNothingMeasuredIsReported) {
  auto points = test::synthetic_points({});
  for (auto& p : points) p.measured_um = std::numeric_limits<double>::quiet_NaN();
  StageReportOptions options = test::scale_options();
  options.feedback = FeedbackSource::kNone;
  const StageReport report = make_stage_report(points, options);
  EXPECT_FALSE(report.observable);
  EXPECT_FALSE(report.error || report.error_to_command || report.increment_error || report.linear || report.fit);
  EXPECT_FALSE(report.reversal || report.repeatability || report.feedback_resolution_um);
  EXPECT_TRUE(report.quantisation && report.settle && report.step_quantum_um);
  EXPECT_THAT(report.caveats, Contains(HasSubstr("not observable")));
}

TEST(StageReport, SaysWhatAMotorEncoderDoesNotSee) {
  StageReportOptions options = test::scale_options();
  options.feedback = FeedbackSource::kMotorEncoder;
  EXPECT_THAT(make_stage_report(test::synthetic_points({}), options).caveats,
              Contains("a motor encoder does not see lead error, backlash or thermal growth of the mechanics"));
  EXPECT_THAT(make_stage_report(test::synthetic_points({}), test::scale_options()).caveats,
              Not(Contains(HasSubstr("motor encoder"))));
}

TEST(StageReport, FewPointsLeaveOutWhatTheyCannotShow) {
  const StageReport none = make_stage_report({}, test::scale_options());
  EXPECT_EQ(none.n, 0);
  EXPECT_FALSE(none.error || none.settle || none.range_um);
  EXPECT_THAT(none.caveats, Contains("there are no points"));

  const auto points = test::synthetic_points({});
  const StageReport one = make_stage_report({points[0]}, test::scale_options());
  ASSERT_TRUE(one.error);
  EXPECT_FALSE(one.error->sd_um);
  EXPECT_FALSE(one.fit || one.linear || one.increment_error);

  const StageReport two = make_stage_report({points[0], points[1]}, test::scale_options());
  ASSERT_TRUE(two.linear && two.fit);
  EXPECT_FALSE(two.linear->alpha_z.standard_error || two.fit->alpha_z->standard_error);
  EXPECT_NEAR(two.linear->residual_rms_um, 0.0, 1e-9);
  EXPECT_FALSE(two.fit->lead || two.fit->drift_um_per_min || two.reversal || two.repeatability);
}

TEST(StageReport, OneRunOrOneDirectionLeavesOutItsFigure) {
  test::SyntheticStage stage;
  stage.runs = 1;
  const StageReport single = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_FALSE(single.repeatability);
  ASSERT_TRUE(single.reversal);
  EXPECT_NEAR(single.reversal->mean_um, 0.8, 0.05);
  EXPECT_NEAR(single.fit->drift_um_per_min->value, 0.25, 0.05 * 0.25) << "the way back shows it";
  EXPECT_THAT(single.caveats, Contains(HasSubstr("repeatability is not observable")));

  stage.runs = 3;
  stage.down = false;
  const StageReport one_way = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_FALSE(one_way.reversal || one_way.fit->reversal_um);
  EXPECT_NEAR(one_way.repeatability->pooled_sd_um, 0.02, 0.003);
  EXPECT_NEAR(one_way.fit->alpha_z->value, 1.0004, 5e-5);
  EXPECT_THAT(one_way.caveats, Contains(HasSubstr("reversal value is not observable")));
}

TEST(StageReport, AllAtOnePositionHasNoSlope) {
  test::SyntheticStage stage;
  stage.positions = 1;
  stage.runs = 50;
  const StageReport report = make_stage_report(test::synthetic_points(stage), test::scale_options());
  EXPECT_FALSE(report.linear || report.fit->alpha_z);
  EXPECT_NEAR(report.reversal->mean_um, 0.8, 0.02);
  EXPECT_NEAR(report.repeatability->pooled_sd_um, 0.02, 0.004);
}

TEST(StageReport, RoundingOfOnePositionIsNoRange) {
  test::SyntheticStage stage;
  stage.positions = 1;
  auto points = test::synthetic_points(stage);
  points[2].quantised_um += 1e-10;
  const StageReport report = make_stage_report(points, test::scale_options());
  EXPECT_FALSE(report.linear || report.fit->alpha_z);
  EXPECT_EQ(report.reversal->positions, 1);
}

TEST(StageReport, ARangeOfWholeLeadsIsNotShortForItsQuantisation) {
  auto points = test::synthetic_points({});
  for (auto& p : points) {
    if (p.quantised_um > 3119.0) p.quantised_um -= 0.01;
  }
  EXPECT_THAT(make_stage_report(points, test::scale_options()).caveats, Not(Contains(HasSubstr("shorter"))));
}

TEST(StageReport, UnknownLeadIsSaid) {
  StageReportOptions options = test::scale_options();
  options.lead_um.reset();
  const StageReport report = make_stage_report(test::synthetic_points({}), options);
  EXPECT_FALSE(report.fit->lead);
  EXPECT_THAT(report.caveats, Contains(HasSubstr("lead is unknown")));
}

TEST(StageReport, RefusesInputThatIsNotFiniteAndNamesThePoint) {
  const auto refused = [](auto change) {
    auto points = test::synthetic_points({});
    change(points[7]);
    try {
      (void)make_stage_report(points, test::scale_options());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadInput);
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_THAT(refused([](StagePoint& p) { p.measured_um = kNan; }), HasSubstr("point 7: measured_um"));
  EXPECT_THAT(refused([](StagePoint& p) { p.quantised_um = kInf; }), HasSubstr("point 7: quantised_um"));
  EXPECT_THAT(refused([](StagePoint& p) { p.commanded_um = -kInf; }), HasSubstr("point 7: commanded_um"));
  EXPECT_THAT(refused([](StagePoint& p) { p.measured_um = 1e12; }), HasSubstr("point 7: measured_um"));
  EXPECT_THAT(refused([](StagePoint& p) { p.time_s = kNan; }), HasSubstr("point 7: time_s"));
  EXPECT_THAT(refused([](StagePoint& p) { p.temperature_c = kNan; }), HasSubstr("point 7: temperature_c"));
  EXPECT_THAT(refused([](StagePoint& p) { p.settle_ms = -1.0; }), HasSubstr("point 7: settle_ms"));
  EXPECT_THAT(refused([](StagePoint& p) { p.direction = 0; }), HasSubstr("point 7: direction"));
  StageReportOptions options = test::scale_options();
  options.lead_um = 0.0;
  EXPECT_THROW((void)make_stage_report({}, options), Error);
  options = test::scale_options();
  options.step_quantum_um = kNan;
  EXPECT_THROW((void)make_stage_report({}, options), Error);
}

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile({4.0, 1.0, 2.0, 3.0}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({5.0}, 0.95), 5.0);
  EXPECT_DOUBLE_EQ(quantile({1.0, 2.0}, 1.0), 2.0);
}

}  // namespace
}  // namespace fvd
