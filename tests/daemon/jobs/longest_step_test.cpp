/// No job that would fail by itself is taken for one that hangs.

#include "daemon/jobs/longest_step.hpp"

#include <gtest/gtest.h>

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

StageInfo quick_stage() {
  StageInfo info;
  info.speed_um_per_s = 1000.0;
  info.acceleration_um_per_s2 = 10000.0;
  return info;
}

TEST(ALongestStep, IsShortForAnOrdinaryRecipe) {
  EXPECT_GT(longest_step({}, quick_stage()), minutes(20)) << "a homing, beside the camera's set-up";
  EXPECT_LT(longest_step({}, quick_stage()), minutes(25));
}

TEST(ALongestStep, HoldsEveryFrameOfASlice) {
  Recipe recipe;
  recipe.camera.exposure_us = 6e7;
  recipe.frame_retries = 10;
  EXPECT_GT(longest_step(recipe, quick_stage()), 11 * 11 * minutes(1));
  recipe.frame_retries = 100;
  EXPECT_GT(longest_step(recipe, quick_stage()), 101 * 101 * minutes(1));
}

TEST(ALongestStep, HoldsEveryMoveOfASlice) {
  Recipe recipe;
  recipe.frame_retries = 0;
  recipe.settle.timeout = minutes(10);
  EXPECT_GT(longest_step(recipe, quick_stage()), 2 * minutes(10) + minutes(10))
      << "the take-up and the slice, after a phase";
  recipe.frame_retries = 5;
  recipe.camera.trigger = TriggerMode::kLine;
  EXPECT_GT(longest_step(recipe, quick_stage()), 2 * 6 * minutes(10)) << "each frame has a way of its own";
}

TEST(ALongestStep, HoldsTheWayToASweepAtItsSpeed) {
  Recipe recipe;
  recipe.mode = ScanMode::kContinuous;
  recipe.step_um = 0.05;
  recipe.slices = 200;
  recipe.speed_um_per_s = 0.5;
  StageInfo far = quick_stage();
  far.take_up = Micrometers{10000.0};
  EXPECT_GT(longest_step(recipe, far), seconds(20020));
  recipe.speed_um_per_s = 1e-30;
  EXPECT_GT(longest_step(recipe, far), minutes(60)) << "no number runs over";
}

}  // namespace
}  // namespace fvd
