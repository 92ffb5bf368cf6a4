#include "core/metrology/edge/section_model.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/metrology/edge/whitening.hpp"
#include "core/metrology/edge/window_profile.hpp"

namespace fvd::metrology::edge {
namespace {

constexpr double kQuarter = std::numbers::pi / 4.0;

LateralKernel box(int size) {
  LateralKernel kernel;
  kernel.weights.assign(static_cast<std::size_t>(size), 1.0 / size);
  return kernel;
}

// Height of a circle of this radius between flanks of 45 degrees, apex at 0.
double circle_height(double s, double radius) {
  if (std::abs(s) >= radius / std::numbers::sqrt2) return -std::abs(s);
  return std::sqrt(radius * radius - s * s) - radius * std::numbers::sqrt2;
}

TEST(AveragedContour, LowersASharpApexByAQuarterOfTheBox) {
  const WindowProfile window(box(9), 1.0, 1.0, 1.0, 0.0);
  const AveragedContour contour({0.0, 0.0, kQuarter, kQuarter, 0.0, 0.0, 0.0}, window);

  const double curvature = (contour.height_um(0.5) - 2.0 * contour.height_um(0.0) + contour.height_um(-0.5)) / 0.25;

  EXPECT_NEAR(window.width_um(), 9.0, 1e-6);
  EXPECT_NEAR(contour.height_um(0.0), -2.25, 1e-9);
  EXPECT_NEAR(-1.0 / curvature, 4.5, 1e-6);
  EXPECT_NEAR(contour.height_um(5.0), -5.0, 1e-12);
}

TEST(AveragedContour, AgreesWithAnOversampledCircle) {
  const WindowProfile window(box(9), 1.0, 1.0, 1.0, 0.0);
  for (const double radius : {5.0, 10.0, 25.0}) {
    const double weight = std::log(std::sin(kQuarter));
    const AveragedContour contour({0.0, 0.0, kQuarter, kQuarter, radius * radius, 0.0, weight}, window);
    for (double s = -25.0; s <= 25.0; s += 1.7) {
      double mean = 0.0;
      for (int i = 0; i < 9000; ++i) mean += circle_height(s - 4.5 + (i + 0.5) / 1000.0, radius) / 9000.0;

      EXPECT_NEAR(contour.height_um(s), mean, 2e-3) << radius << " at " << s;
      const double slope = (contour.height_um(s + 1e-4) - contour.height_um(s - 1e-4)) / 2e-4;
      EXPECT_NEAR(contour.slope(s), slope, 2e-3) << radius << " at " << s;
    }
  }
}

TEST(WindowProfile, IsTheProjectionOfASquareBoxSeenAtAnAngle) {
  const double angle = 17.0 * std::numbers::pi / 180.0;
  const WindowProfile window(box(9), 1.0, 1.0, std::cos(angle), std::sin(angle));
  for (const double s : {0.0, 1.3, 4.0, 5.5}) {
    double mean = 0.0;
    for (int j = 0; j < 900; ++j) {
      for (int i = 0; i < 900; ++i) {
        const double x = (i + 0.5) / 100.0 - 4.5;
        const double y = (j + 0.5) / 100.0 - 4.5;
        mean += std::abs(s - x * std::cos(angle) - y * std::sin(angle)) / 810000.0;
      }
    }

    EXPECT_NEAR(window.mean_distance_um(s), mean, 1e-4) << s;
  }
}

TEST(WindowProfile, IsWiderByWhatTheOperatorAdds) {
  const double angle = 17.0 * std::numbers::pi / 180.0;
  for (const double operator_px2 : {0.0, 0.5, 5.0}) {
    LateralKernel kernel = box(5);
    kernel.operator_px2 = operator_px2;
    const WindowProfile window(kernel, 2.0, 2.0, std::cos(angle), std::sin(angle));
    const WindowProfile bare(box(5), 2.0, 2.0, std::cos(angle), std::sin(angle));

    // The mean distance exceeds the distance itself by the window's variance, summed over all places.
    double variance = 0.0;
    for (double s = -30.0; s < 30.0; s += 0.01) variance += 0.01 * (window.mean_distance_um(s) - std::abs(s));

    EXPECT_NEAR(variance, 4.0 * (25.0 / 12.0 + operator_px2), 0.003);
    EXPECT_EQ(window.width_um(), bare.width_um());
  }
}

TEST(Whitening, UndoesTheCorrelationItIsMadeOf) {
  std::vector<double> s;
  for (int i = 0; i < 40; ++i) s.push_back(0.5 * i + (i % 3 == 0 ? 0.1 : 0.0));
  Eigen::MatrixXd covariance(40, 40);
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const double away = std::abs(s[static_cast<std::size_t>(i)] - s[static_cast<std::size_t>(j)]);
      covariance(i, j) = (i == j ? 1.3 : std::fmax(0.0, 1.0 - away / 5.0));
    }
  }

  const Whitening whitening(s, 5.0);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(40, 40);
  whitening.apply(inverse);
  whitening.apply_transposed(inverse);

  EXPECT_LT((inverse * covariance - Eigen::MatrixXd::Identity(40, 40)).cwiseAbs().maxCoeff(), 1e-10);
}

}  // namespace
}  // namespace fvd::metrology::edge
