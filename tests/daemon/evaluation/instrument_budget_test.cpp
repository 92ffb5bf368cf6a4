/// What constants, temperature and gauge studies add to U, by formulas written down again.

#include "daemon/evaluation/instrument_budget.hpp"

#include <memory>
#include <numbers>

#include <nlohmann/json.hpp>

#include "daemon/evaluation/value_names.hpp"
#include "tests/daemon/evaluation/made_surfaces.hpp"

namespace fvd {
namespace {

using test::evaluated;
using test::known_slices;
using test::level_groove;
using test::surface_of;
using test::u_of;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

EvaluationContext whole() {
  EvaluationContext context = known_slices();
  Calibration calibration;
  calibration.id = "cal-0007";
  calibration.z = ZConstants{1.0, 0.002, 0.05, 0.0, 0.0, {}};
  calibration.flatness = FlatnessConstants{0.12, 0.004, "", {}};
  calibration.lateral = LateralConstants{1.0, 1.0, 0.003, 0.001, 0.0, 0.0, 0.0, 0.0, {}};
  calibration.texture = TextureConstants{2.5, {}};
  context.calibration = calibration;
  context.temperature_c = 26.0;
  return context;
}

constexpr const char* kGroove = R"({"expansion_per_k": 11.5e-6,
  "measurements": {"step": {"kind": "step_height", "edges_um": [105, 195]}}})";

/// Hills 30 um apart, 5 um high from middle to top.
Surface waves(int columns = 60) {
  const auto wave = [](double at_um) { return std::sin(2.0 * std::numbers::pi * at_um / 30.0); };
  return surface_of([wave](double x_um, double y_um) { return 5.0 * wave(x_um) * wave(y_um); }, columns);
}

constexpr const char* kTexture = R"({"expansion_per_k": 11.5e-6,
  "measurements": {"t": {"kind": "areal", "parameters": ["Sq", "Sku", "Sdq", "Sdr", "Sal"], "limits": {
    "Sku": {"upper": 9}, "Sdq": {"upper": 9}, "Sdr_percent": {"upper": 900}, "Sal_um": {"upper": 99}}}}})";

const EvaluatedValue& value_in(const Evaluation& evaluation, const char* measurement, const char* key) {
  return evaluation.measurements.at(measurement).values.at(key);
}

/// As `source` alone adds it.
double relative(const EvaluatedValue& value, const char* source) { return u_of(value, source) / value.value.value(); }

TEST(TheBudgetOfAStep, HasTheConstantsOfTheAxisAndTheFlat) {
  const Evaluation evaluation = evaluated(level_groove(), kGroove, whole());

  const EvaluatedValue& height = value_in(evaluation, "step", "height_um");
  EXPECT_NEAR(u_of(height, "alpha_z"), 50.0 * 0.002, 1e-6);
  EXPECT_DOUBLE_EQ(u_of(height, "l_z"), 0.05 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(u_of(height, "flatness"), 0.12 / (2.0 * std::sqrt(3.0)));
  EXPECT_NEAR(u_of(height, "temperature"), 50.0 * 11.5e-6 * 6.0 / std::sqrt(3.0), 1e-8);
  EXPECT_TRUE(std::isnan(u_of(height, "lateral")));
  EXPECT_TRUE(std::isnan(u_of(height, "reproducibility")));
  double squares = 0.0;
  for (const UncertaintyLine& line : height.budget) squares += line.u * line.u;
  EXPECT_NEAR(height.u.value(), std::sqrt(squares), 1e-12);
  EXPECT_GT(height.u.value(), 0.1);
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, ::testing::ElementsAre("lead", "repeatability"));
}

TEST(TheBudgetOfAStep, CountsTheUncertaintyOfTheAmplificationRelativeToIt) {
  EvaluationContext context = whole();
  context.calibration->z->alpha_z = 1.25;

  const EvaluatedValue height = value_in(evaluated(level_groove(), kGroove, context), "step", "height_um");

  EXPECT_NEAR(u_of(height, "alpha_z"), 40.0 * 0.002 / 1.25, 1e-6);
}

TEST(TheBudgetOfAStep, HasTheErrorOfTheReferenceInPlaceOfTheFlatness) {
  EvaluationContext context = whole();
  auto map = std::make_shared<metrology::HeightField>();
  map->z_um = Plane<double>(test::kColumns, test::kRows, 0.0);
  map->sigma_um = Plane<float>(test::kColumns, test::kRows, 0.004F);
  context.flatness_reference = map;

  const Evaluation evaluation =
      evaluated(level_groove(), R"({"surfaces": {"s": {"steps": [{"op": "flatness_reference"}]},
      "t": {"from": "s"}},
    "measurements": {"step": {"kind": "step_height", "surface": "t", "edges_um": [105, 195]}}})",
                context);

  EXPECT_DOUBLE_EQ(u_of(value_in(evaluation, "step", "height_um"), "flatness"), 0.004);
}

TEST(TheBudgetOfAStep, DoesNotTakeAnUnknownLinearityForAStraightAxis) {
  EvaluationContext context = whole();
  context.calibration->z->linearity_um = 0.0;

  const Evaluation evaluation = evaluated(level_groove(), kGroove, context);

  EXPECT_TRUE(std::isnan(u_of(value_in(evaluation, "step", "height_um"), "l_z")));
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Contains("l_z"));
}

TEST(TheBudgetOfAStep, HasTheScrewsPeriodicErrorWhereItIsKnown) {
  EvaluationContext context = whole();
  context.calibration->z->lead_amplitude_um = 0.3;
  context.calibration->z->lead_um = 500.0;

  const Evaluation evaluation = evaluated(level_groove(), kGroove, context);

  double squares = 0.0;  // over all phases
  for (int i = 0; i < 1000; ++i) {
    const double phase = 2.0 * std::numbers::pi * i / 1000.0;
    const double error_um = 0.3 * (std::sin(phase + 2.0 * std::numbers::pi * 50.0 / 500.0) - std::sin(phase));
    squares += error_um * error_um / 1000.0;
  }
  EXPECT_NEAR(u_of(value_in(evaluation, "step", "height_um"), "lead"), std::sqrt(squares), 1e-6);
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Not(Contains("lead")));
}

TEST(TheBudgetOfAStep, IsTheSameForRegionsAndLevels) {
  const Evaluation evaluation = evaluated(level_groove(), R"({
    "regions": {"top": {"rectangle_um": {"x": 10, "y": 5, "width": 80, "height": 50}},
                "bottom": {"rectangle_um": {"x": 115, "y": 5, "width": 70, "height": 50}}},
    "measurements": {"one": {"kind": "step_between", "lower": "bottom", "upper": "top"},
                     "all": {"kind": "levels", "regions": ["bottom", "top"]}}})",
                                          whole());

  for (const EvaluatedValue& value :
       {value_in(evaluation, "one", "height_um"), value_in(evaluation, "all", "top-bottom_um")}) {
    EXPECT_NEAR(u_of(value, "alpha_z"), 0.1, 1e-4);
    EXPECT_DOUBLE_EQ(u_of(value, "l_z"), 0.05 / std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(u_of(value, "flatness"), 0.12 / (2.0 * std::sqrt(3.0)));
    EXPECT_TRUE(std::isnan(u_of(value, "temperature")));  // nobody says of what the part is
  }
  EXPECT_THAT(evaluation.measurements.at("one").not_evaluated, Contains("temperature"));
}

TEST(TheBudgetOfATexture, CountsEachPowerOfItsLengths) {
  const Evaluation evaluation = evaluated(waves(), kTexture, whole());

  const double expansion = 11.5e-6 * 6.0 / std::sqrt(3.0);
  const EvaluatedValue& sq = value_in(evaluation, "t", "Sq_um");
  EXPECT_NEAR(relative(sq, "alpha_z"), 0.002, 1e-9);
  EXPECT_NEAR(relative(sq, "reproducibility"), 0.025, 1e-9);
  EXPECT_NEAR(relative(sq, "temperature"), expansion, 1e-12);
  EXPECT_TRUE(std::isnan(u_of(sq, "lateral")));
  EXPECT_TRUE(std::isnan(u_of(sq, "l_z")));
  const EvaluatedValue& sdq = value_in(evaluation, "t", "Sdq");
  EXPECT_NEAR(relative(sdq, "alpha_z"), 0.002, 1e-9);
  EXPECT_NEAR(relative(sdq, "lateral"), 0.003, 1e-9);
  EXPECT_TRUE(std::isnan(u_of(sdq, "temperature")));  // grows in z as in x
  EXPECT_TRUE(std::isnan(u_of(sdq, "reproducibility")));
  const EvaluatedValue& sdr = value_in(evaluation, "t", "Sdr_percent");
  EXPECT_NEAR(relative(sdr, "alpha_z"), 0.004, 1e-9);
  EXPECT_NEAR(relative(sdr, "lateral"), 0.006, 1e-9);
  const EvaluatedValue& sal = value_in(evaluation, "t", "Sal_um");
  EXPECT_NEAR(relative(sal, "lateral"), 0.003, 1e-9);
  EXPECT_NEAR(relative(sal, "temperature"), expansion, 1e-12);
  EXPECT_TRUE(std::isnan(u_of(sal, "alpha_z")));
  for (const UncertaintyLine& line : value_in(evaluation, "t", "Sku").budget) {
    EXPECT_THAT(line.source, ::testing::AnyOf("noise", "slice_z"));
  }
}

TEST(TheBudgetOfATexture, KeepsAmongTheUnknownWhatItDoesNotContain) {
  const auto not_evaluated = evaluated(waves(), kTexture, whole()).measurements.at("t").not_evaluated;

  EXPECT_THAT(not_evaluated, IsSupersetOf({"flatness", "l_z", "repeatability", "window_transfer"}));
  for (const char* known : {"alpha_z", "lateral", "reproducibility", "temperature"}) {
    EXPECT_THAT(not_evaluated, Not(Contains(known)));
  }
}

TEST(TheBudgetOfAProfile, IsThatOfATexture) {
  const Evaluation evaluation = evaluated(waves(300), R"({"measurements": {"p": {"kind": "profile", "from_um": [5, 37],
    "to_um": [295, 37], "band_width_um": 5, "parameters": ["Ra", "RSm", "Rdq"], "nesting_um": 80, "sections": 2}}})",
                                          whole());

  EXPECT_NEAR(relative(value_in(evaluation, "p", "Ra_um"), "alpha_z"), 0.002, 1e-9);
  EXPECT_NEAR(relative(value_in(evaluation, "p", "Ra_um"), "reproducibility"), 0.025, 1e-9);
  EXPECT_NEAR(relative(value_in(evaluation, "p", "RSm_um"), "lateral"), 0.003, 1e-9);
  EXPECT_NEAR(relative(value_in(evaluation, "p", "Rdq"), "lateral"), 0.003, 1e-9);
  EXPECT_THAT(evaluation.measurements.at("p").not_evaluated, Not(Contains("lateral")));
}

double noise_floor_in(const Evaluation& evaluation) {
  return nlohmann::json::parse(evaluation.measurements.at("t").details)["noise_floor_Sq_um"].get<double>();
}

TEST(TheNoiseFloor, IsWhatScansShowedNotWhatStandardErrorsTell) {
  const std::string plan = R"({"measurements": {"t": {"kind": "areal", "parameters": ["Sq"],
                                                      "limits": {"Sq_um": {"lower": 0.1}}}}})";
  EvaluationContext context = whole();
  const Evaluation told = evaluated(waves(), plan, context);
  context.calibration->z->alpha_z = 1.25;
  context.calibration->noise = NoiseConstants{2.0, {}};

  const Evaluation seen = evaluated(waves(), plan, context);

  EXPECT_NEAR(noise_floor_in(told), 0.2, 1e-6);
  EXPECT_EQ(value_in(told, "t", "Sq_um").verdict, Verdict::kPass);
  EXPECT_NEAR(noise_floor_in(seen), 2.0 / 1.25, 1e-12);  // above half of Sq, 2.5 / 1.25
  EXPECT_EQ(value_in(seen, "t", "Sq_um").verdict, Verdict::kUncertain);
}

TEST(TheNoiseFloor, FallsBehindAFilterAsTheStandardErrorsDo) {
  const std::string plan = R"({"surfaces": {"s": {"steps": [{"op": "filter", "side": "S", "nesting_um": 20}]}},
    "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sq"]}}})";
  EvaluationContext context = known_slices();
  const double told_um = noise_floor_in(evaluated(waves(), plan, context));
  context.calibration = Calibration{};
  context.calibration->noise = NoiseConstants{0.3, {}};

  EXPECT_LT(told_um, 0.19);
  EXPECT_NEAR(noise_floor_in(evaluated(waves(), plan, context)), 0.3 / 0.2 * told_um, 1e-4);
}

TEST(TheLateralEntry, CountsAPitchThatWasNotCorrected) {
  EvaluationContext context = whole();
  context.calibration->lateral->pitch_x_um = 1.01;  // the surface has 1.0
  const std::string corrected = R"({"surfaces": {"s": {"steps": [{"op": "lateral"}]}},
    "measurements": {"t": {"kind": "areal", "surface": "s", "parameters": ["Sal"], "limits": {"Sal_um": {"upper": 99}}}}})";

  const double left = relative(value_in(evaluated(waves(), kTexture, context), "t", "Sal_um"), "lateral");
  const double none = relative(value_in(evaluated(waves(), corrected, context), "t", "Sal_um"), "lateral");

  EXPECT_NEAR(none, 0.003 / 1.01, 1e-9);
  EXPECT_NEAR(left, std::hypot(0.003 / 1.01, (1.0 - 1.0 / 1.01) / std::sqrt(3.0)), 1e-9);
}

TEST(TheTemperatureEntry, CountsColdAsWarm) {
  EvaluationContext cold = whole();
  cold.temperature_c = 14.0;

  EXPECT_DOUBLE_EQ(u_of(value_in(evaluated(level_groove(), kGroove, cold), "step", "height_um"), "temperature"),
                   u_of(value_in(evaluated(level_groove(), kGroove, whole()), "step", "height_um"), "temperature"));
}

TEST(Repeatability, IsWhatTheNoiseDoesNotExplain) {
  EvaluationContext context = known_slices();
  const double noise_um = u_of(value_in(evaluated(level_groove(), kGroove, context), "step", "height_um"), "noise");
  context.repeatability["step.height_um"] = {5.0 * noise_um, 24.0, "study-9"};

  const Evaluation evaluation = evaluated(level_groove(), kGroove, context);

  const EvaluatedValue& height = value_in(evaluation, "step", "height_um");
  EXPECT_NEAR(u_of(height, "repeatability"), std::sqrt(24.0) * noise_um, 1e-12);
  EXPECT_EQ(height.budget.back().type, "A");
  EXPECT_EQ(height.budget.back().dof, 24.0);
  EXPECT_LT(height.dof.value(), 30.0);
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Contains("repeatability"));  // of height_areal_um
}

TEST(Repeatability, AddsNothingWhereTheNoiseExplainsItAll) {
  EvaluationContext context = known_slices();
  context.repeatability["step.height_um"] = {1e-6, 24.0, "study-9"};

  const EvaluatedValue height = value_in(evaluated(level_groove(), kGroove, context), "step", "height_um");

  EXPECT_EQ(u_of(height, "repeatability"), 0.0);
  EXPECT_FALSE(height.dof);
}

TEST(Repeatability, OfValuesThatNeverDifferedIsNoUncertaintyByItself) {
  EvaluationContext context = known_slices();
  context.repeatability["step.width_um"] = {0.0, 24.0, "study-9"};

  const Evaluation evaluation = evaluated(
      level_groove(),
      R"({"measurements": {"step": {"kind": "step_height", "edges_um": [105, 195], "limits": {"width_um": {"lower": 80}}}}})",
      context);

  EXPECT_FALSE(value_in(evaluation, "step", "width_um").u);
  EXPECT_EQ(value_in(evaluation, "step", "width_um").verdict, Verdict::kUncertain);
}

TEST(Repeatability, OfAnotherMeasurementOrValueIsNotTaken) {
  EvaluationContext context = known_slices();
  context.repeatability["other.height_um"] = {1.0, 24.0, "study-9"};
  context.repeatability["step.width_um"] = {0.3, 24.0, "study-9"};

  const Evaluation evaluation = evaluated(level_groove(), kGroove, context);

  EXPECT_TRUE(std::isnan(u_of(value_in(evaluation, "step", "height_um"), "repeatability")));
  EXPECT_EQ(value_in(evaluation, "step", "width_um").u, 0.3);
  EXPECT_EQ(value_in(evaluation, "step", "width_um").u_method, "repeated");
}

TEST(TheConstantsOfTheInstrument, AreNoUncertaintyByThemselves) {
  Surface surface = level_groove();
  surface.sigma_m = Plane<float>();

  const Evaluation evaluation = evaluated(surface, kGroove, whole());

  EXPECT_FALSE(value_in(evaluation, "step", "height_um").u);
  EXPECT_THAT(value_in(evaluation, "step", "height_um").budget, IsEmpty());
  EXPECT_THAT(evaluation.measurements.at("step").not_evaluated, Contains("noise"));
}

TEST(TheConstantsOfTheInstrument, AreAllUnknownWithoutACalibration) {
  EvaluationContext context = known_slices();
  context.temperature_c = 26.0;

  EXPECT_THAT(evaluated(level_groove(), kGroove, context).measurements.at("step").not_evaluated,
              ::testing::ElementsAre("alpha_z", "flatness", "l_z", "lead", "repeatability"));
  EXPECT_THAT(evaluated(waves(), kTexture, context).measurements.at("t").not_evaluated,
              IsSupersetOf({"alpha_z", "flatness", "l_z", "lateral", "repeatability", "reproducibility"}));
}

TEST(ThePowersOfAValue, AreThoseOfItsLengths) {
  EXPECT_EQ(value_powers("levels", "top-Sal_um"), (ValuePowers{1.0, 0.0}));
  EXPECT_EQ(value_powers("step_height", "bottom_radius_um"), (ValuePowers{-1.0, 2.0}));
  EXPECT_EQ(value_powers("areal", "Vmc_um"), (ValuePowers{1.0, 0.0}));
  EXPECT_EQ(value_powers("areal", "Smr1_percent"), ValuePowers{});
  EXPECT_EQ(value_powers("cutting_edge", "S_gamma_um"), (ValuePowers{0.0, 1.0}));
  for (const char* none : {"beta_deg", "K", "phi_deg", "notches", "chipping_max_um", "residual_rms_um"}) {
    EXPECT_EQ(value_powers("cutting_edge", none), ValuePowers{});
  }
}

}  // namespace
}  // namespace fvd
