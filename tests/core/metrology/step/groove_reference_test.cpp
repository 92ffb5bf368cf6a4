/// Grooves of known depth: the value, its refusals, and its noise against what is observed.

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "core/metrology/step/groove_step.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/step/made_field.hpp"

namespace fvd::metrology {
namespace {

using test::made_field;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// 90 um wide and 50 um deep about x = 150, slopes 0.02 and 0.01; every tenth point a hole.
HeightField tilted_groove(double sign = 1.0) {
  int count = 0;
  return made_field(300, 60, [&count, sign](double x, double y) {
    if (++count % 10 == 3) return kNaN;
    return 0.02 * x + 0.01 * y - sign * (std::abs(x - 150.0) < 45.0 ? 50.0 : 0.0);
  });
}

template <typename T>
T given(StepOutcome<T> outcome) {
  if (const auto* refusal = std::get_if<StepRefusal>(&outcome)) throw std::runtime_error(refusal->text);
  return std::get<T>(std::move(outcome));
}

template <typename T>
StepRefusalCode refused(const StepOutcome<T>& outcome) {
  return std::get<StepRefusal>(outcome).code;
}

TEST(AGroove, HasItsDepthAcrossItsTilt) {
  const GrooveStep step = given(iso5436_a1(tilted_groove(), {}));

  EXPECT_EQ(step.sign, GrooveSign::kGroove);
  EXPECT_NEAR(step.edges.left_um, 105.0, 1e-9);
  EXPECT_NEAR(step.edges.right_um, 195.0, 1e-9);
  EXPECT_NEAR(step.areal.vertical_um, 50.0, 1e-9);
  EXPECT_NEAR(step.areal.height_um, 50.0 / std::sqrt(1.0005), 1e-9);
  EXPECT_NEAR(step.mean.height_um, 50.0 / std::sqrt(1.0004), 1e-9);
  EXPECT_NEAR(step.areal.slope_x, 0.02, 1e-12);
  EXPECT_EQ(step.traces.each.size(), 9U);
  EXPECT_NEAR(step.traces.sd_um, 0.0, 1e-9);
  for (const StepRegion& region : step.regions) EXPECT_NEAR(region.valid_fraction(), 0.9, 0.02);
}

TEST(ARidge, HasAPositiveHeight) {
  const GrooveStep step = given(iso5436_a1(tilted_groove(-1.0), {}));

  EXPECT_EQ(step.sign, GrooveSign::kRidge);
  EXPECT_NEAR(step.areal.height_um, 50.0 / std::sqrt(1.0005), 1e-9);
}

TEST(AGrooveAlongX, IsMeasuredByTracesAlongY) {
  const HeightField field = made_field(
      60, 300, [](double x, double y) { return 0.01 * x + 0.02 * y - (std::abs(y - 150.0) < 45.0 ? 50.0 : 0.0); });
  GrooveSettings settings;
  settings.across = Across::kY;

  const GrooveStep step = given(iso5436_a1(field, settings));

  EXPECT_NEAR(step.areal.height_um, 50.0 / std::sqrt(1.0005), 1e-9);
  EXPECT_NEAR(step.areal.slope_y, 0.02, 1e-12);
  EXPECT_NEAR(step.areal.slope_x, 0.01, 1e-12);
  double sum = 0.0;
  for (const double weight : step.areal.weights.weights.pixels()) sum += weight;
  EXPECT_NEAR(sum, 0.0, 1e-9) << "a shift of the whole surface moves no step";
  EXPECT_EQ(step.areal.weights.weights.height(), 270);
}

TEST(AGroove, IsRefusedWithTheReason) {
  const HeightField flat =
      made_field(300, 60, [](double x, double y) { return 0.1 * std::sin(1.3 * x * x) + 0.001 * y; });
  EXPECT_EQ(refused(iso5436_a1(flat, {})), StepRefusalCode::kNoEdges);

  GrooveSettings outside;
  outside.band = FromTo{10.0, 80.0};
  EXPECT_EQ(refused(iso5436_a1(tilted_groove(), outside)), StepRefusalCode::kOutside);

  GrooveSettings many;
  many.traces = 61;
  EXPECT_EQ(refused(iso5436_a1(tilted_groove(), many)), StepRefusalCode::kTooFewTraces);

  GrooveSettings beyond;
  beyond.edges = GrooveEdges{20.0, 140.0};
  EXPECT_EQ(refused(iso5436_a1(tilted_groove(), beyond)), StepRefusalCode::kTooFewValid);
}

TEST(ARoundedGroove, HasTheDepthOfItsVertex) {
  const auto surface = [](double x, double y) {
    const double half = x - 152.0;
    const double bottom = -40.0 + 100.0 - std::sqrt(100.0 * 100.0 - half * half);
    return 0.02 * x + 0.01 * y + (std::abs(x - 150.0) < 45.0 ? bottom : 0.0);
  };
  GrooveSettings settings;
  settings.edges = GrooveEdges{105.0, 195.0};

  const RoundedGroove groove = given(iso5436_a2(made_field(300, 60, surface), settings, BottomForm::kCircle));

  // The tilt was added along z, which hardly bends the circle.
  EXPECT_NEAR(groove.mean.height_um, 40.0 / std::sqrt(1.0004), 0.01);
  EXPECT_NEAR(groove.radius_um, 100.0, 0.5);
  EXPECT_EQ(refused(iso5436_a2(tilted_groove(), settings)), StepRefusalCode::kNotRounded);
}

/// Heights and u of 400 grooves with noise of a window of 9.
struct Draws {
  double sd_um = 0.0;
  double u_um = 0.0;
  int covered = 0;
};

Draws drawn(int draws) {
  HeightField field = made_field(300, 60, [](double x, double) { return std::abs(x - 150.0) < 45.0 ? -50.0 : 0.0; });
  field.sigma_um = Plane<float>(300, 60, 0.25F);
  field.kernel.weights.assign(9, 1.0 / 9.0);
  GrooveSettings settings;
  settings.edges = GrooveEdges{105.0, 195.0};
  NoiseMaps noise(field, 7);
  Draws found;
  double squares = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    HeightField noisy = field.clone();
    noise.add_to_heights(static_cast<std::uint64_t>(draw), noisy.z_um);
    const GrooveStep step = given(iso5436_a1(noisy, settings));
    const double error = step.mean.height_um - 50.0;
    found.u_um = step.mean.noise.value().u;
    squares += error * error;
    found.covered += std::abs(error) <= 1.959964 * found.u_um ? 1 : 0;
  }
  found.sd_um = std::sqrt(squares / draws);
  return found;
}

TEST(TheNoiseOfAGroove, IsWhatIsPredicted) {
  const Draws found = drawn(400);

  ::testing::Test::RecordProperty("step_sd_ratio", std::to_string(found.sd_um / found.u_um));
  ::testing::Test::RecordProperty("step_coverage_of_400", found.covered);
  EXPECT_GT(found.sd_um / found.u_um, 0.9);
  EXPECT_LT(found.sd_um / found.u_um, 1.1);
  EXPECT_GE(found.covered, 368);
  EXPECT_LE(found.covered, 392);
  EXPECT_GT(found.u_um, 6.0 * 0.25 * std::sqrt(1.0 / 1800.0 + 1.0 / 3600.0)) << "neighbours share their errors";
}

}  // namespace
}  // namespace fvd::metrology
