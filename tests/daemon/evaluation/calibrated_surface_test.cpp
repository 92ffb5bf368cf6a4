/// Evaluations with the constants of an instrument: heights, operations, what is missing.

#include <limits>
#include <memory>

#include <nlohmann/json.hpp>

#include "tests/daemon/evaluation/made_surfaces.hpp"

namespace fvd {
namespace {

using test::evaluated;
using test::kColumns;
using test::known_slices;
using test::kRows;
using test::level_groove;
using test::surface_of;
using test::u_of;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kGroove = R"({"measurements": {"step": {"kind": "step_height", "edges_um": [105, 195]}}})";

EvaluationContext calibrated(double alpha_z) {
  EvaluationContext context = known_slices();
  context.calibration = Calibration{};
  context.calibration->id = "cal-0003";
  context.calibration->z = ZConstants{};
  context.calibration->z->alpha_z = alpha_z;
  return context;
}

const EvaluatedValue& height(const Evaluation& evaluation) {
  return evaluation.measurements.at("step").values.at("height_um");
}

nlohmann::json steps_of(const Evaluation& evaluation, const std::string& surface) {
  return nlohmann::json::parse(evaluation.surfaces.at(surface));
}

TEST(ACalibratedSurface, HasItsHeightsDividedByTheAmplification) {
  const Evaluation plain = evaluated(level_groove(), kGroove, known_slices());
  const Evaluation divided = evaluated(level_groove(), kGroove, calibrated(1.25));

  EXPECT_NEAR(height(divided).value.value(), 40.0, 1e-4);
  EXPECT_NEAR(u_of(height(divided), "noise"), u_of(height(plain), "noise") / 1.25, 1e-8);
  EXPECT_EQ(divided.calibration, "cal-0003");
}

TEST(ACalibratedSurface, TellsTheAmplificationAmongItsSteps) {
  const Evaluation evaluation = evaluated(level_groove(), R"({"surfaces": {"s": {"steps": [{"op": "invert"}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
                                          calibrated(1.25));

  const nlohmann::json expected{{"op", "calibration"}, {"alpha_z", 1.25}, {"calibration", "cal-0003"}};
  EXPECT_EQ(steps_of(evaluation, "measured"), nlohmann::json::array({expected}));
  ASSERT_THAT(steps_of(evaluation, "s"), SizeIs(2));
  EXPECT_EQ(steps_of(evaluation, "s")[0], expected);
}

TEST(ACalibratedSurface, WithoutConstantsOfZIsAsItWasMeasured) {
  EvaluationContext context = calibrated(1.25);
  context.calibration->z.reset();

  const Evaluation evaluation = evaluated(level_groove(), kGroove, context);

  EXPECT_NEAR(height(evaluation).value.value(), 50.0, 1e-4);
  EXPECT_EQ(evaluation.calibration, "cal-0003");
  EXPECT_THAT(evaluation.surfaces, IsEmpty());
}

TEST(ASurfaceWithoutCalibration, SaysNone) {
  const Evaluation evaluation = evaluated(level_groove(), kGroove, known_slices());

  EXPECT_EQ(evaluation.calibration, "none");
  EXPECT_THAT(evaluation.surfaces, IsEmpty());
  EXPECT_THAT(evaluation.measurements.at("step").warnings, IsEmpty());
}

/// The slices are where the stage says: a surface of other heights would rest on others.
TEST(ACalibratedSurface, RestsOnTheSlicesThatItWasMeasuredWith) {
  const Surface surface = level_groove(47.0);
  const double plain = u_of(height(evaluated(surface, kGroove, known_slices())), "slice_z");

  const double divided = u_of(height(evaluated(surface, kGroove, calibrated(1.25))), "slice_z");

  EXPECT_NEAR(divided, plain / 1.25, 1e-9);
}

TEST(TheLateralStep, TakesThePitchOfTheCalibration) {
  EvaluationContext context = calibrated(1.0);
  context.calibration->lateral = LateralConstants{2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {}};

  const Evaluation evaluation = evaluated(level_groove(), R"({"surfaces": {"s": {"steps": [{"op": "lateral"}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [210, 390]}}})",
                                          context);

  EXPECT_NEAR(height(evaluation).value.value(), 50.0, 1e-4);
  const nlohmann::json did = steps_of(evaluation, "s").back()["did"]["values"];
  EXPECT_EQ(did["pitch_x_um"]["value"], 2.0);
  EXPECT_EQ(did["pitch_y_um"]["value"], 3.0);
}

TEST(TheLateralStep, IsRefusedForAShearThatNoInstrumentHas) {
  EvaluationContext context = calibrated(1.0);
  context.calibration->lateral = LateralConstants{1.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, {}};

  const Evaluation evaluation = evaluated(level_groove(), R"({"surfaces": {"s": {"steps": [{"op": "lateral"}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
                                          context);

  EXPECT_THAT(evaluation.measurements.at("step").reason, HasSubstr("shear"));
  EXPECT_EQ(evaluation.measurements.at("step").reason_code, evaluation_code::kInvalid);
}

constexpr const char* kFlattened = R"({"surfaces": {"s": {"steps": [{"op": "flatness_reference"}]}},
  "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195],
    "limits": {"height_um": {"lower": -60, "upper": 60}}}}})";

/// 3 um higher in the groove than beside it, known to 0.15 um; one hole.
std::shared_ptr<metrology::HeightField> reference_map(int columns = kColumns) {
  auto map = std::make_shared<metrology::HeightField>();
  map->z_um = Plane<double>(columns, kRows, 0.0);
  map->sigma_um = Plane<float>(columns, kRows, 0.15F);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 105; column < 195; ++column) map->z_um.at(column, row) = 3.0;
  }
  map->z_um.at(150, 30) = std::numeric_limits<double>::quiet_NaN();
  map->sigma_um.at(150, 30) = std::numeric_limits<float>::quiet_NaN();
  return map;
}

EvaluationContext with_reference(double alpha_z, int columns = kColumns) {
  EvaluationContext context = calibrated(alpha_z);
  context.calibration->flatness = FlatnessConstants{0.12, 0.004, "cal-0003-flatness.gsf", {}};
  context.flatness_reference = reference_map(columns);
  return context;
}

TEST(TheFlatnessStep, SubtractsTheReferenceMap) {
  const Evaluation plain = evaluated(level_groove(), kGroove, calibrated(1.0));

  const Evaluation evaluation = evaluated(level_groove(), kFlattened, with_reference(1.0));

  EXPECT_NEAR(height(evaluation).value.value(), 53.0, 1e-4);
  EXPECT_EQ(steps_of(evaluation, "s").back()["did"]["points_removed"], 1);
  EXPECT_EQ(evaluation.measurements.at("step").points, plain.measurements.at("step").points - 1);
  const double grown = std::hypot(0.2, 0.15) / 0.2;
  EXPECT_NEAR(u_of(height(evaluation), "noise") / u_of(height(plain), "noise"), grown, 2e-3);
}

TEST(TheFlatnessStep, DividesTheReferenceAsTheHeights) {
  const Evaluation evaluation = evaluated(level_groove(), kFlattened, with_reference(1.25));

  EXPECT_NEAR(height(evaluation).value.value(), 53.0 / 1.25, 1e-4);
}

TEST(TheFlatnessStep, IsRefusedForAMapOfAnotherSize) {
  const Evaluation evaluation = evaluated(level_groove(), kFlattened, with_reference(1.0, kColumns + 1));

  EXPECT_THAT(evaluation.measurements.at("step").reason, HasSubstr("size"));
  EXPECT_EQ(evaluation.measurements.at("step").verdict, Verdict::kInvalid);
}

TEST(ACalibrationStep, WithoutItsConstantsIsInvalidAndSaysWhatToDo) {
  const std::string lateral = R"({"surfaces": {"s": {"steps": [{"op": "lateral"}]}, "t": {"from": "s"}},
    "measurements": {"step": {"kind": "step_height", "surface": "t", "edges_um": [105, 195],
      "limits": {"height_um": {"upper": 60}}}}})";
  EvaluationContext no_map = with_reference(1.0);
  no_map.flatness_reference.reset();
  struct Case {
    std::string plan;
    EvaluationContext context;
    std::string what_to_do;
  };
  const std::vector<Case> cases{{lateral, known_slices(), "fvdctl calibrate lateral"},
                                {lateral, calibrated(1.0), "fvdctl calibrate lateral"},
                                {kFlattened, known_slices(), "fvdctl calibrate flatness"},
                                {kFlattened, calibrated(1.0), "fvdctl calibrate flatness"},
                                {kFlattened, no_map, "cal-0003-flatness.gsf"}};

  for (const Case& one : cases) {
    const EvaluatedMeasurement step = evaluated(level_groove(), one.plan, one.context).measurements.at("step");

    EXPECT_EQ(step.verdict, Verdict::kInvalid);
    EXPECT_EQ(step.reason_code, 1143);
    EXPECT_THAT(step.reason, AllOf(HasSubstr("cannot be made"), HasSubstr(one.what_to_do)));
  }
}

TEST(TheReasonsStep, MakesHolesOfPointsThatCarryOneOfThem) {
  Surface surface = level_groove();
  surface.mask = Plane<MaskReasons>(kColumns, kRows, 0);
  surface.mask.at(10, 10) = mask_reason::kSaturated;
  surface.mask.at(11, 10) = mask_reason::kSaturated | mask_reason::kEdgeBand;
  surface.mask.at(12, 10) = mask_reason::kSecondPeak;

  const Evaluation evaluation = evaluated(
      surface, R"({"surfaces": {"s": {"steps": [{"op": "mask_reasons", "reasons": ["saturated", "outlier"]}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
      known_slices());

  EXPECT_EQ(steps_of(evaluation, "s").back()["did"]["points_removed"], 2);
}

TEST(TheReasonsStep, MovesWithThePointsThatAShearMoved) {
  Surface surface = level_groove();
  surface.mask = Plane<MaskReasons>(kColumns, kRows, 0);
  surface.mask.at(100, 50) = mask_reason::kSaturated;
  surface.height_m.at(100, 50) = std::numeric_limits<float>::quiet_NaN();
  EvaluationContext context = calibrated(1.0);
  context.calibration->lateral = LateralConstants{1.0, 1.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, {}};

  const Evaluation evaluation = evaluated(
      surface, R"({"surfaces": {"s": {"steps": [{"op": "lateral"}, {"op": "mask_reasons", "reasons": ["saturated"]}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
      context);

  EXPECT_EQ(steps_of(evaluation, "s").back()["did"]["points_removed"], 0);
}

TEST(TheReasonsStep, IsRefusedForASurfaceThatDoesNotTellThem) {
  const Evaluation evaluation =
      evaluated(level_groove(), R"({"surfaces": {"s": {"steps": [{"op": "mask_reasons", "reasons": ["saturated"]}]}},
    "measurements": {"step": {"kind": "step_height", "surface": "s", "edges_um": [105, 195]}}})",
                known_slices());

  EXPECT_THAT(evaluation.measurements.at("step").reason, HasSubstr("mask.png"));
  EXPECT_EQ(evaluation.measurements.at("step").reason_code, evaluation_code::kInvalid);
}

Problems problems_of(const std::string& surfaces) {
  Problems problems;
  (void)test::read_plan(
      R"({"surfaces": )" + surfaces + R"(, "measurements": {"t": {"kind": "areal", "parameters": ["Sa"]}}})", problems);
  return problems;
}

TEST(APlanWithCalibration, IsAcceptedInTheOrderOfTheManual) {
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "mask_reasons", "reasons": ["outlier"]},
    {"op": "flatness_reference"}, {"op": "lateral"}, {"op": "level"}]}})"),
              IsEmpty());
}

TEST(APlanWithCalibration, IsRefusedWhereAStepWouldBeWrong) {
  const auto at = [](const char* pointer) { return Contains(Field(&Problem::pointer, HasSubstr(pointer))); };
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "lateral"}, {"op": "flatness_reference"}]}})"),
              at("/surfaces/s/steps/1/op"));
  EXPECT_THAT(
      problems_of(
          R"({"s": {"steps": [{"op": "invert"}]}, "t": {"from": "s", "steps": [{"op": "flatness_reference"}]}})"),
      at("/surfaces/t/steps/0/op"));
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "lateral"}]}, "t": {"from": "s", "steps": [{"op": "lateral"}]}})"),
              at("/surfaces/t/steps/0/op"));
  EXPECT_THAT(problems_of(R"({"s": {"from": "t", "steps": [{"op": "lateral"}]}, "t": {"from": "s"}})"),
              at("/surfaces/s/from"));
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "mask_reasons", "reasons": []}]}})"),
              at("/surfaces/s/steps/0/reasons"));
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "mask_reasons"}]}})"), at("/surfaces/s/steps/0/reasons"));
  EXPECT_THAT(problems_of(R"({"s": {"steps": [{"op": "mask_reasons", "reasons": ["dust"]}]}})"),
              at("/surfaces/s/steps/0/reasons"));
}

}  // namespace
}  // namespace fvd
