/// From a result to the values of its job.

#include "daemon/jobs/job_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fvd {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

MeasuredValue valid_fraction() {
  MeasuredValue value;
  value.name = "valid_fraction";
  value.value = 0.97;
  value.limits = Limits{0.5, std::nullopt};
  value.verdict = Verdict::kPass;
  return value;
}

EvaluatedMeasurement a_step() {
  EvaluatedValue height;
  height.value = 50.01;
  height.u = 0.01;
  height.expanded_u = 0.02;
  height.limits = Limits{49.0, 51.0};
  height.verdict = Verdict::kUncertain;
  EvaluatedValue width;
  width.reason = "no edge";
  EvaluatedMeasurement step;
  step.main_value = "height_um";
  step.values = {{"height_um", height}, {"width_um", width}};
  return step;
}

TEST(ValuesOfAResult, AreThoseOfTheMapWhereThereIsNoEvaluation) {
  Result result;
  EXPECT_THAT(values_of(result), IsEmpty());
  result.measurements = {valid_fraction()};
  EXPECT_THAT(values_of(result), ElementsAre(StoredValue{"map", "valid_fraction", 0.97, {}, {}, 0.5, {}, "pass"}));
}

TEST(ValuesOfAResult, AreThoseOfTheEvaluationInTheRecipesOrderAndThenOfTheMap) {
  Result result;
  result.measurements = {valid_fraction()};
  result.evaluation.emplace();
  result.evaluation->order = {"step", "broken", "gone"};
  EvaluatedMeasurement broken;
  broken.main_value = "Sa_um";
  broken.verdict = Verdict::kInvalid;
  result.evaluation->measurements = {{"broken", broken}, {"step", a_step()}};

  EXPECT_THAT(values_of(result),
              ElementsAre(StoredValue{"step", "height_um", 50.01, 0.01, 0.02, 49.0, 51.0, "uncertain"},
                          StoredValue{"step", "width_um", {}, {}, {}, {}, {}, ""},
                          StoredValue{"broken", "Sa_um", {}, {}, {}, {}, {}, "invalid"},
                          StoredValue{"map", "valid_fraction", 0.97, {}, {}, 0.5, {}, "pass"}));
}

TEST(ValuesOfAResult, LeaveTheMapOutWhereTheRecipeHasAMeasurementOfThatName) {
  Result result;
  result.measurements = {valid_fraction()};
  result.evaluation.emplace();
  result.evaluation->order = {"map"};
  EvaluatedMeasurement nameless;  // failed before anybody knew what it would have given
  result.evaluation->measurements = {{"map", nameless}};

  EXPECT_THAT(values_of(result), ElementsAre(StoredValue{"map", "map", {}, {}, {}, {}, {}, ""}));
}

}  // namespace
}  // namespace fvd
