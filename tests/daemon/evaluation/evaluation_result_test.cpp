/// Evaluations are written and read back as they were.

#include "daemon/result/evaluation_result.hpp"

#include <gmock/gmock.h>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"

namespace fvd {
namespace {

using ::testing::IsEmpty;

Evaluation sample() {
  Evaluation evaluation;
  evaluation.verdict = Verdict::kUncertain;
  evaluation.rule = "iso14253_1";
  evaluation.surfaces = {{"primary", R"([{"op":"level"}])"}};
  evaluation.order = {"step", "edge"};
  EvaluatedMeasurement step;
  step.id = "step";
  step.kind = "step_height";
  step.method = "iso5436_a1";
  step.surface = "primary";
  step.points = 18230;
  step.valid_fraction = 0.998;
  step.main_value = "height_um";
  step.not_evaluated = {"temperature"};
  step.details = R"({"slope":0.0203})";
  step.cross_section = CrossSection{1.5, 2.25, 100.0, 2.0, 9.0, {{"A", 0.125, 7.0}, {"C", 8.0, 9.5}}};
  step.cross_section->fit_name = "fitted lines";
  step.cross_section->fit = {{{0.125, 7.0}, {100.25, 101.5}}, {{8.0}, {50.0}}};
  step.verdict = Verdict::kUncertain;
  EvaluatedValue height;
  height.value = 49.985;
  height.unit = "um";
  height.u = 0.024;
  height.expanded_u = 0.048;
  height.k = 2.02;
  height.dof = 38.0;
  height.u_method = "linear";
  height.budget = {{"noise", "A", 0.023, {}, 71.0}, {"slice_z", "B", 0.006, {}, {}}};
  height.limits = Limits{49.5, {}};
  height.verdict = Verdict::kUncertain;
  height.probability = 0.93;
  height.warnings = {{"code", "text"}};
  step.values = {{"height_um", height}};
  EvaluatedMeasurement edge;
  edge.kind = "cutting_edge";
  edge.surface = "measured";
  edge.reason = "no edge";
  edge.reason_code = evaluation_code::kInvalid;
  edge.verdict = Verdict::kInvalid;
  evaluation.measurements = {{"step", step}, {"edge", edge}};
  return evaluation;
}

TEST(AnEvaluationsJson, ReadsBackTheSame) {
  Evaluation written = sample();
  const auto json = fields_to_json([&](Fields& fields) { describe(written, fields); });

  Evaluation read;
  Problems problems;
  read_document(
      json.dump(), [&read](Fields& fields) { describe(read, fields); }, problems);
  EXPECT_THAT(problems, IsEmpty());

  EXPECT_EQ(read, sample());
}

}  // namespace
}  // namespace fvd
