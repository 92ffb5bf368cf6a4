#include "core/focus/window_kernel.hpp"

#include <numeric>

#include <gmock/gmock.h>

namespace fvd {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::SizeIs;

TEST(WindowKernel, OfABoxIsFlat) {
  FocusSettings settings;
  settings.window = FocusWindow::kBox;
  settings.window_px = 9;

  const LateralKernel kernel = window_kernel(settings);

  EXPECT_THAT(kernel.weights, SizeIs(9));
  EXPECT_THAT(kernel.weights, Each(DoubleNear(1.0 / 9.0, 1e-15)));
  EXPECT_NEAR(kernel.width_px(), 9.0, 1e-12);
}

TEST(WindowKernel, OfADoubleBoxFallsToTheRimAndSumsToOne) {
  FocusSettings settings;
  settings.window = FocusWindow::kDoubleBox;
  settings.window_px = 9;
  const WindowSides sides = window_sides(settings);

  const LateralKernel kernel = window_kernel(settings);

  ASSERT_THAT(kernel.weights, SizeIs(static_cast<std::size_t>(sides.first + sides.second - 1)));
  EXPECT_EQ(kernel.weights.size() % 2, 1U);
  EXPECT_NEAR(std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0), 1.0, 1e-12);
  for (std::size_t i = 0; i < kernel.weights.size() / 2; ++i) {
    EXPECT_LE(kernel.weights[i], kernel.weights[i + 1]);
    EXPECT_DOUBLE_EQ(kernel.weights[i], kernel.weights[kernel.weights.size() - 1 - i]);
  }
  EXPECT_LT(kernel.weights.front(), kernel.weights[kernel.weights.size() / 2]);
}

TEST(WindowKernel, KnowsTheVarianceOfItsOperatorsPixels) {
  FocusSettings settings;
  settings.distance_px = 2;
  const auto variance = [&](FocusOperator op) {
    settings.focus_operator = op;
    return 1.5 * window_kernel(settings).operator_px2;  // two thirds of it count
  };

  // Pixels of the diagonal Laplacian: 2 x (2, -1, -1) along each axis, 1 x along four diagonals, two of them half as
  // far.
  EXPECT_NEAR(variance(FocusOperator::kDiagonalLaplacian), (2.0 * 4.0 + 2.0 * 4.0 + 2.0 * 1.0) / 3.0 / 8.0, 1e-12);
  EXPECT_NEAR(variance(FocusOperator::kModifiedLaplacian), 4.0 / 3.0 / 2.0, 1e-12);
  EXPECT_NEAR(variance(FocusOperator::kTenengrad), (4.0 + 4.0 / 3.0) / 2.0, 1e-12);
  EXPECT_EQ(variance(FocusOperator::kIntensity), 0.0);
}

}  // namespace
}  // namespace fvd
