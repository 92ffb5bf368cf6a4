#include "core/stage/step_history.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/stage/quantile.hpp"
#include "core/stage/stage_accuracy.hpp"

namespace fvd {
namespace {

StepLog random_log(std::mt19937& generator, int slices) {
  std::normal_distribution<double> error(0.05, 0.2);
  std::lognormal_distribution<double> move(4.0, 0.3);
  StepLog log(static_cast<std::size_t>(slices));
  for (int i = 0; i < slices; ++i) {
    StepRecord& step = log[static_cast<std::size_t>(i)];
    step.index = i;
    step.measured = i % 17 != 16;
    step.error_um = error(generator);
    step.move_ms = move(generator);
  }
  return log;
}

TEST(StepHistory, AgreesWithTheBatchOverManyScans) {
  std::mt19937 generator(1);
  StepHistory history(FeedbackSource::kLinearScale);
  std::vector<double> errors;
  std::vector<double> moves;
  StepLog all;  // with a lost slice between the scans, across which there is no increment
  for (int scan = 0; scan < 40; ++scan) {
    const StepLog log = random_log(generator, 100);
    history.add(log);
    all.insert(all.end(), log.begin(), log.end());
    all.emplace_back().measured = false;
    for (const auto& step : log) {
      if (!step.measured) continue;
      errors.push_back(std::abs(step.error_um));
      moves.push_back(step.move_ms);
    }
  }
  const StepSummary batch = summarize_steps(all);
  const StepHistorySummary summary = history.summary();
  EXPECT_EQ(summary.scans, 40U);
  EXPECT_EQ(summary.steps, static_cast<std::uint64_t>(batch.steps));
  EXPECT_EQ(summary.lost_steps, 40U * 5);
  EXPECT_TRUE(summary.observable);
  EXPECT_NEAR(summary.error_mean_um.value(), batch.error_mean_um, 1e-12);
  EXPECT_NEAR(summary.error_sd_um.value(), batch.error_sd_um, 1e-12);
  EXPECT_EQ(summary.error_max_um.value(), batch.error_max_um);
  EXPECT_NEAR(summary.increment_error_sd_um.value(), batch.increment_error_sd_um, 1e-12);
  EXPECT_EQ(summary.increment_error_max_um.value(), batch.increment_error_max_um);
  EXPECT_NEAR(summary.error_p95_um.value() / quantile(errors, 0.95), 1.0, 0.025);
  EXPECT_NEAR(summary.move_p50_ms.value() / batch.move_median_ms, 1.0, 0.025);
  EXPECT_NEAR(summary.move_p95_ms.value() / quantile(moves, 0.95), 1.0, 0.025);
  EXPECT_EQ(summary.move_max_ms.value(), batch.move_max_ms);
}

TEST(StepHistory, MergesAndRestoresToTheSame) {
  std::mt19937 generator(2);
  StepHistory whole(FeedbackSource::kMotorEncoder);
  StepHistory first(FeedbackSource::kMotorEncoder);
  StepHistory second(FeedbackSource::kMotorEncoder);
  for (int scan = 0; scan < 20; ++scan) {
    const StepLog log = random_log(generator, 30 + scan);
    whole.add(log);
    (scan < 7 ? first : second).add(log);
  }
  StepHistory merged(first.state());
  merged.merge(second);
  merged.merge(StepHistory(FeedbackSource::kMotorEncoder));
  EXPECT_EQ(merged.state().error_sizes.counts, whole.state().error_sizes.counts);
  EXPECT_EQ(merged.state().move_times.counts, whole.state().move_times.counts);
  EXPECT_EQ(merged.summary().scans, 20U);
  EXPECT_NEAR(merged.summary().error_mean_um.value(), whole.summary().error_mean_um.value(), 1e-12);
  EXPECT_NEAR(merged.summary().error_sd_um.value(), whole.summary().error_sd_um.value(), 1e-12);
  EXPECT_NEAR(merged.summary().increment_error_sd_um.value(), whole.summary().increment_error_sd_um.value(), 1e-12);
}

TEST(StepHistory, KeepsItsFiguresOverAsManyStepsAsYearsHold) {
  RunningMoments moments;  // an offset a million times the spread is what naive sums fail at
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (int i = 0; i < 2'000'000; ++i) moments.add(10'000.0 + noise(generator));
  EXPECT_NEAR(moments.sd().value(), 0.01, 5e-5);
}

TEST(StepHistory, EmptyIsUnknownAndNotZero) {
  const StepHistorySummary summary = StepHistory(FeedbackSource::kLinearScale).summary();
  EXPECT_EQ(summary.scans, 0U);
  EXPECT_FALSE(summary.error_mean_um || summary.error_sd_um || summary.error_p95_um || summary.move_p50_ms);
}

TEST(StepHistory, WithoutFeedbackOnlyTimesAreKept) {
  std::mt19937 generator(4);
  StepHistory history(FeedbackSource::kNone);
  history.add(random_log(generator, 50));
  const StepHistorySummary summary = history.summary();
  EXPECT_FALSE(summary.observable);
  EXPECT_FALSE(summary.error_mean_um || summary.error_p95_um || summary.increment_error_sd_um);
  EXPECT_TRUE(summary.move_p95_ms);
  EXPECT_NO_THROW(StepHistory{history.state()});
  StepHistory other(FeedbackSource::kLinearScale);
  EXPECT_THROW(other.merge(history), Error);
}

TEST(StepHistory, RefusesAValueThatWouldSpoilIt) {
  std::mt19937 generator(5);
  StepHistory history(FeedbackSource::kLinearScale);
  StepLog log = random_log(generator, 10);
  log[4].error_um = std::numeric_limits<double>::quiet_NaN();
  try {
    history.add(log);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadInput);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("slice 4"));
  }
  EXPECT_EQ(history.summary().steps, 0U) << "nothing of the scan was added";
  log[4].measured = false;
  EXPECT_NO_THROW(history.add(log)) << "a lost slice has no values";
}

TEST(StepHistory, RefusesAStateThatContradictsItself) {
  std::mt19937 generator(6);
  StepHistory history(FeedbackSource::kLinearScale);
  history.add(random_log(generator, 10));
  StepHistoryState state = history.state();
  ++state.steps;
  EXPECT_THROW(StepHistory{state}, Error);
  state = history.state();
  state.error.mean = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(StepHistory{state}, Error);
  state = history.state();
  state.feedback = FeedbackSource::kNone;
  EXPECT_THROW(StepHistory{state}, Error);
}

TEST(MagnitudeHistogram, CoversItsRangeAndClampsBeyond) {
  for (const double value : {2e-5, 0.013, 1.0, 777.0, 4e6}) {
    MagnitudeHistogram histogram;
    histogram.add(value);
    EXPECT_NEAR(histogram.quantile(0.95).value() / value, 1.0, 0.022) << value;
  }
  MagnitudeHistogram histogram;
  EXPECT_FALSE(histogram.quantile(0.5));
  histogram.add(0.0);
  EXPECT_EQ(histogram.quantile(0.5), 0.0);
  histogram.add(1e300);
  EXPECT_GT(histogram.quantile(1.0).value(), 5e6);
}

}  // namespace
}  // namespace fvd
