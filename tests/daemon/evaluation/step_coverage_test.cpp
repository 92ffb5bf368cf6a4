/// U of a step under errors of the instrument, drawn as its constants describe them.

#include <random>

#include "tests/daemon/evaluation/made_surfaces.hpp"

namespace fvd {
namespace {

using ::testing::IsEmpty;

constexpr int kWidth = 60;
constexpr int kHeight = 24;
constexpr int kBox = 3;
constexpr double kStep_um = 50.0;
constexpr double kSigma_um = 0.2;
constexpr double kAlphaError = 6e-4;
constexpr double kLinearity_um = 0.05;
constexpr double kExpansion_per_k = 23e-6;
constexpr double kWarmth_k = 30.0;

/// A step in the middle, with noise that is white noise averaged by a box.
class NoisyStep {
 public:
  NoisyStep() {
    surface_.height_m = Plane<float>(kWidth, kHeight);
    surface_.sigma_m = Plane<float>(kWidth, kHeight, static_cast<float>(kSigma_um * 1e-6));
    surface_.pitch_x_um = 1.0;
    surface_.pitch_y_um = 1.0;
    surface_.kernel.weights.assign(kBox, 1.0 / kBox);
  }

  const Surface& draw(double step_um, std::mt19937_64& random) {
    std::normal_distribution<double> noise(0.0, kSigma_um * kBox);  // its mean over the box has kSigma_um
    Plane<double> white(kWidth + kBox - 1, kHeight + kBox - 1);
    for (double& value : white.pixels()) value = noise(random);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double sum = 0.0;
        for (int i = 0; i < kBox * kBox; ++i) sum += white.at(x + i % kBox, y + i / kBox);
        const double z_um = (x < kWidth / 2 ? 0.0 : step_um) + sum / (kBox * kBox);
        surface_.height_m.at(x, y) = static_cast<float>(z_um * 1e-6);
      }
    }
    return surface_;
  }

 private:
  Surface surface_;
};

EvaluationContext context_of() {
  EvaluationContext context;
  context.calibration = Calibration{};
  context.calibration->id = "cal-0001";
  context.calibration->z = ZConstants{1.01, kAlphaError, kLinearity_um, 0.0, 0.0, {}};
  context.temperature_c = 20.0 + kWarmth_k;
  return context;
}

TEST(UOfAStep, HoldsTheTruthAsOftenAsItSays) {
  Problems problems;
  const EvaluationPlan plan = test::read_plan(R"({"expansion_per_k": 23e-6,
    "regions": {"low": {"rectangle_um": {"x": 4, "y": 2, "width": 22, "height": 20}},
                "high": {"rectangle_um": {"x": 34, "y": 2, "width": 22, "height": 20}}},
    "measurements": {"step": {"kind": "step_between", "lower": "low", "upper": "high", "slope": "fixed"}}})",
                                              problems);
  ASSERT_THAT(problems, IsEmpty());
  const EvaluationContext context = context_of();
  std::mt19937_64 random(20261129);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  NoisyStep part;
  constexpr int kDraws = 2000;
  int held = 0;

  for (int draw = 0; draw < kDraws; ++draw) {
    const double alpha_z = 1.01 + kAlphaError * normal(random);
    const double grown_um = kStep_um * (1.0 + kExpansion_per_k * kWarmth_k * even(random));
    const double read_um = alpha_z * (grown_um + kLinearity_um * even(random));
    const Evaluation evaluation = evaluate_surface(part.draw(read_um, random), plan, context, nullptr);
    const EvaluatedValue& height = evaluation.measurements.at("step").values.at("height_um");
    ASSERT_EQ(height.budget.size(), 4U);
    if (std::abs(*height.value - kStep_um) <= *height.expanded_u) ++held;
  }

  EXPECT_GE(held, 0.94 * kDraws);
  EXPECT_LE(held, 0.98 * kDraws);
  RecordProperty("held_of_2000", held);
}

}  // namespace
}  // namespace fvd
