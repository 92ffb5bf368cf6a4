/// A measurement of several scans, on a camera and an axis in this process.

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/pipeline/measurement.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "sim/fakes/fakes.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

constexpr int kSide_px = 64;
constexpr int kSlices = 11;
constexpr double kStep_um = 10.0;
constexpr double kPlane_um = 47.0;

/// A flat textured surface that every scan sees anew, with other noise.
class AFlatSurface : public ::testing::Test {
 protected:
  AFlatSurface() {
    recipe_.step_um = kStep_um;
    recipe_.slices = kSlices;
    recipe_.bin_slices = 1;
    std::mt19937 random(7);  // fixed, as the noise's
    std::uniform_real_distribution<double> grey(-1.0, 1.0);
    for (double& texture : texture_) texture = grey(random);
  }

  struct Measured {
    ResultData data;
    std::vector<std::string> phases;
    std::vector<int> progress;
    int acquired = 0;
    int earlier_scans = 0;
    FrameCounts last_frames;
  };
  Measured measure_with(int repeat, std::deque<sim::TriggerOutcome> script = {}) {
    recipe_.repeat = repeat;
    sim::FakeClock clock;
    sim::FakeCamera camera(clock, kSide_px, kSide_px, std::move(script));
    sim::FakeAxis stage(clock);
    camera.paint = [&stage, this](int trigger, std::span<std::byte> pixels) {
      paint(stage.targets_um.back() - warming_um_ * ((trigger - 1) / kSlices), pixels);
    };
    WorkerPool pool(1);
    Measured measured;
    MeasurementObserver observer;
    observer.on_phase = [&](std::string_view phase) { measured.phases.emplace_back(phase); };
    observer.on_slice = [&](const SliceProgress& progress) {
      measured.progress.push_back(progress.slices);
      measured.last_frames = progress.frames;
    };
    observer.on_acquired = [&] { ++measured.acquired; };
    observer.on_earlier_scan = [&](const StepLog& steps) {
      EXPECT_EQ(steps.size(), static_cast<std::size_t>(kSlices));
      EXPECT_EQ(measured.acquired, 0) << "the part is held until the last scan's last slice";
      ++measured.earlier_scans;
    };
    note_recipe(recipe_, measured.data);
    measure(recipe_, {camera, stage, clock, pool, nullptr, 64}, observer, measured.data, {});
    return measured;
  }
  void paint(double z_um, std::span<std::byte> pixels) {
    const double contrast = 80.0 * std::exp(-std::pow((z_um - kPlane_um) / 18.0, 2));
    std::normal_distribution<double> noise(0.0, 2.0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double grey = 128.0 + contrast * texture_[i] + noise(noise_);
      pixels[i] = static_cast<std::byte>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }

  Recipe recipe_;
  double warming_um_ = 0.0;  ///< of the part, from scan to scan
  std::array<double, kSide_px * kSide_px> texture_{};
  std::mt19937 noise_{42};
};

/// Root mean square of what the two maps differ by, over sqrt 2: the noise of one of them.
double noise_um(const HeightMap& a, const HeightMap& b) {
  double squares = 0.0;
  int points = 0;
  for (std::size_t i = 0; i < a.height_m.pixels().size(); ++i) {
    if (a.mask.pixels()[i] != 0 || b.mask.pixels()[i] != 0) continue;
    const double difference_um =
        1e6 * (static_cast<double>(a.height_m.pixels()[i]) - static_cast<double>(b.height_m.pixels()[i]));
    squares += difference_um * difference_um;
    ++points;
  }
  EXPECT_GT(points, kSide_px * kSide_px / 2);
  return std::sqrt(squares / points / 2.0);
}

double rms_um(const Plane<float>& values_m) {
  double squares = 0.0;
  int points = 0;
  for (const float value_m : values_m.pixels()) {
    if (std::isnan(value_m)) continue;
    squares += 1e12 * static_cast<double>(value_m) * static_cast<double>(value_m);
    ++points;
  }
  return std::sqrt(squares / std::max(points, 1));
}

TEST_F(AFlatSurface, HasHalfTheNoiseInTheMeanOfFourScans) {
  const double of_one = noise_um(measure_with(1).data.map, measure_with(1).data.map);
  const Measured four = measure_with(4);
  const double of_four = noise_um(four.data.map, measure_with(4).data.map);

  RecordProperty("noise_of_one_um", std::to_string(of_one));
  RecordProperty("noise_of_four_um", std::to_string(of_four));
  RecordProperty("sigma_over_noise", std::to_string(rms_um(four.data.map.sigma_m) / of_four));
  RecordProperty("sd_rms_um", std::to_string(four.data.repeated.value().sd_rms_um.value()));
  EXPECT_GT(of_one, 0.02);
  EXPECT_GT(of_one / of_four, 1.6);
  EXPECT_LT(of_one / of_four, 2.4);
  ASSERT_TRUE(four.data.repeated.has_value());
  EXPECT_EQ(four.data.repeated->scans, 4);
  EXPECT_NEAR(*four.data.repeated->sd_rms_um, of_one, 0.25 * of_one) << "the scatter is that of single scans";
  EXPECT_NEAR(rms_um(four.data.repeated->sd_m), *four.data.repeated->sd_rms_um, 1e-4);
  // What the curves say of their own noise is that of the mean: half of one scan's.
  const double predicted_um = rms_um(four.data.map.sigma_m);
  EXPECT_GT(predicted_um / of_four, 0.5);
  EXPECT_LT(predicted_um / of_four, 2.0);
}

TEST_F(AFlatSurface, IsTakenInManyScansAsOneJob) {
  const Measured measured = measure_with(3);

  EXPECT_THAT(measured.phases, ::testing::ElementsAre("preparing", "acquiring", "computing"));
  EXPECT_EQ(measured.acquired, 1);
  EXPECT_EQ(measured.earlier_scans, 2);
  ASSERT_EQ(measured.progress.size(), 3U * kSlices);
  for (std::size_t i = 0; i < measured.progress.size(); ++i) {
    EXPECT_EQ(measured.progress[i], static_cast<int>(i) + 1);
  }
  EXPECT_EQ(measured.last_frames.ok, 3U * kSlices);
  EXPECT_EQ(measured.data.frames.ok, 3U * kSlices);
  EXPECT_TRUE(measured.data.frames.balanced());
  EXPECT_EQ(measured.data.slices_planned, 3 * kSlices);
  EXPECT_EQ(measured.data.slices_measured_before, 2 * kSlices);
  EXPECT_EQ(measured.data.steps.size(), static_cast<std::size_t>(kSlices)) << "the log is the last scan's";
}

TEST_F(AFlatSurface, WarnsOfAPartThatMovesFromScanToScan) {
  EXPECT_THAT(measure_with(3).data.warnings, ::testing::IsEmpty());
  warming_um_ = 2.0;

  const Measured measured = measure_with(3);

  ASSERT_EQ(measured.data.warnings.size(), 1U);
  EXPECT_EQ(measured.data.warnings[0].code, "repeat_scatter");
}

TEST_F(AFlatSurface, IsOneScanUnlessMoreAreAskedFor) {
  const Measured measured = measure_with(1);

  EXPECT_FALSE(measured.data.repeated.has_value());
  EXPECT_EQ(measured.earlier_scans, 0);
  EXPECT_EQ(measured.data.slices_planned, kSlices);
  EXPECT_EQ(measured.data.slices_measured_before, 0);
}

TEST_F(AFlatSurface, KeepsTheLossesOfEveryScanInItsBooks) {
  recipe_.allowed_lost_slices = 1;
  recipe_.frame_retries = 0;
  std::deque<sim::TriggerOutcome> script(kSlices + 3, sim::TriggerOutcome::kFrame);
  script[4] = sim::TriggerOutcome::kNothing;  // of the first scan
  script[kSlices + 2] = sim::TriggerOutcome::kNothing;

  const Measured measured = measure_with(3, script);

  EXPECT_EQ(measured.data.frames.missing, 2U);
  EXPECT_EQ(measured.data.frames.ok, 3U * kSlices - 2U);
  EXPECT_EQ(measured.data.slices_measured_before, 2 * kSlices - 2);
}

TEST_F(AFlatSurface, EndsTheJobWithTheErrorOfWhicheverScanFails) {
  recipe_.frame_retries = 0;
  std::deque<sim::TriggerOutcome> script(2 * kSlices, sim::TriggerOutcome::kFrame);
  script[kSlices + 5] = sim::TriggerOutcome::kNothing;  // of the second scan

  FVD_EXPECT_ERROR(kCameraFramesLost, (void)measure_with(3, script));
}

}  // namespace
}  // namespace fvd
