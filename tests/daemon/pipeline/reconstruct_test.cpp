#include "daemon/pipeline/reconstruct.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace fvd {
namespace {

/// 41 slices, 5 um apart from -7 um on.
StepLog steps() {
  StepLog log;
  for (int k = 0; k < 41; ++k) log.push_back({.index = k, .measured_um = -7.0 + 5.0 * k});
  return log;
}

/// So many of 1000 points at the end, the others in the middle of the range.
int bins_with(int at_end, double end_um) {
  Plane<float> height_m(40, 25);
  int left = at_end;
  for (float& height : height_m.pixels()) height = static_cast<float>(1e-6 * (left-- > 0 ? end_um : 93.0));
  height_m.at(39, 24) = std::numeric_limits<float>::quiet_NaN();
  return most_bin_slices(height_m, steps(), 5.0);
}

TEST(MostBinSlices, KeepsAPlateauNearEitherEnd) {
  EXPECT_EQ(bins_with(0, 0.0), 20) << "the middle is twenty steps from either end";
  EXPECT_EQ(bins_with(300, 0.0), 1) << "two slices see peaks from half a step above 0 um on";
  EXPECT_EQ(bins_with(300, 10.0), 3);
  EXPECT_EQ(bins_with(300, 186.0), 1);
  EXPECT_EQ(bins_with(300, 182.0), 2);
}

TEST(MostBinSlices, MindsNoSinglePoints) { EXPECT_EQ(bins_with(3, 0.0), 20); }

TEST(MostBinSlices, DoesNotLookAtLostSlices) {
  Plane<float> height_m(4, 4);
  for (float& height : height_m.pixels()) height = 0.0F;
  StepLog log = steps();
  log.push_back({.index = 41, .measured = false, .measured_um = -100.0});
  EXPECT_EQ(most_bin_slices(height_m, log, 5.0), 1);
}

}  // namespace
}  // namespace fvd
