/// Scans upwards and downwards over the same slices, on a camera and an axis in this process.

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/pipeline/measurement.hpp"
#include "daemon/pipeline/reconstruct.hpp"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

constexpr int kSide_px = 64;
constexpr double kPlane_um = 47.0;

/// A flat textured surface on a stage with lost motion: it stands higher than it says where it came from above, as a
/// load that rests on a worn screw does.
class ATwoWaySurface : public ::testing::Test {
 protected:
  ATwoWaySurface() {
    recipe_.step_um = 10.0;
    recipe_.slices = 11;
    recipe_.bin_slices = 1;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> grey(-1.0, 1.0);
    for (double& texture : texture_) texture = grey(random);
  }

  ResultData measured(bool downwards) {
    recipe_.downwards = downwards;
    sim::FakeClock clock;
    sim::FakeCamera camera(clock, kSide_px, kSide_px);
    sim::FakeAxis stage(clock);
    camera.paint = [&stage, this](int, std::span<std::byte> pixels) {
      const auto& moves = stage.targets_um;
      const bool from_above = moves.size() > 1 && moves[moves.size() - 2] > moves.back();
      paint(moves.back() + (from_above ? lost_motion_um_ : 0.0), pixels);
    };
    WorkerPool pool(1);
    MeasurementObserver observer;
    observer.on_phase = [](std::string_view) {};
    observer.on_slice = [](const SliceProgress&) {};
    observer.on_acquired = [] {};
    ResultData data;
    note_recipe(recipe_, data);
    measure(recipe_, {camera, stage, clock, pool, nullptr, 64}, observer, data, {});
    targets_um_ = stage.targets_um;
    return data;
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
  double lost_motion_um_ = 0.0;
  std::vector<double> targets_um_;
  std::array<double, kSide_px * kSide_px> texture_{};
  std::mt19937 noise_{42};
};

double mean_um(const HeightMap& map) {
  double sum = 0.0;
  int points = 0;
  for (const float height : map.height_m.pixels()) {
    if (std::isnan(height)) continue;
    sum += 1e6 * static_cast<double>(height);
    ++points;
  }
  EXPECT_GT(points, kSide_px * kSide_px / 2);
  return sum / points;
}

TEST_F(ATwoWaySurface, IsTakenDownwardsFromTheHighestSliceAfterATakeUpAboveIt) {
  const ResultData down = measured(true);

  EXPECT_EQ(targets_um_, (std::vector<double>{120, 100, 90, 80, 70, 60, 50, 40, 30, 20, 10, 0}));
  ASSERT_EQ(down.steps.size(), 11U);
  EXPECT_EQ(down.steps.front().index, 0);
  EXPECT_EQ(down.steps.front().commanded_um, 100.0);
  EXPECT_EQ(down.steps.back().commanded_um, 0.0);
}

TEST_F(ATwoWaySurface, HasTheSameHeightsEitherWayOnAStageWithoutLostMotion) {
  const double up_um = mean_um(measured(false).map);
  const double down_um = mean_um(measured(true).map);

  EXPECT_NEAR(up_um, kPlane_um, 0.1);
  EXPECT_NEAR(down_um, up_um, 0.05);
}

TEST_F(ATwoWaySurface, IsSeenLowerDownwardsByTheStagesLostMotion) {
  lost_motion_um_ = 1.2;

  const double up_um = mean_um(measured(false).map);
  const double down_um = mean_um(measured(true).map);

  EXPECT_NEAR(up_um, kPlane_um, 0.1) << "the take-up loads the screw";
  EXPECT_NEAR(down_um - up_um, -1.2, 0.05);
}

}  // namespace
}  // namespace fvd
