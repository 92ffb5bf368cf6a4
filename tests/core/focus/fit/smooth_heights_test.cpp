#include "core/focus/fit/smooth_heights.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

constexpr int kSide = 120;
constexpr int kBorder = 12;
constexpr double kNoise_um = 0.15;

struct Map {
  Plane<float> height_m = Plane<float>(kSide, kSide);
  Plane<float> sigma_m = Plane<float>(kSide, kSide);
};

/// surface_um(x, y) and errors that are one over a box of side window.
template <typename Surface>
Map noisy(const Surface& surface_um, int window) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, kNoise_um * window);
  Plane<double> white(kSide + window, kSide + window);
  for (double& value : white.pixels()) value = normal(random);
  Map map;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      double sum = 0.0;
      for (int v = 0; v < window; ++v) {
        for (int u = 0; u < window; ++u) sum += white.at(x + u, y + v);
      }
      map.height_m.at(x, y) = static_cast<float>(1e-6 * (surface_um(x, y) + sum / (window * window)));
      map.sigma_m.at(x, y) = static_cast<float>(1e-6 * kNoise_um);
    }
  }
  return map;
}

struct Figures {
  double rms_um = 0.0;
  double largest_um = 0.0;
  double sigma_um = 0.0;  ///< root of the mean square
  int points = 0;
};

template <typename Surface, typename Where>
Figures figures_of(const Plane<float>& height_m, const Plane<float>& sigma_m, const Surface& surface_um,
                   const Where& where) {
  Figures figures;
  for (int y = kBorder; y < kSide - kBorder; ++y) {
    for (int x = kBorder; x < kSide - kBorder; ++x) {
      if (!where(x, y) || std::isnan(height_m.at(x, y))) continue;
      const double error = 1e6 * static_cast<double>(height_m.at(x, y)) - surface_um(x, y);
      figures.rms_um += error * error;
      figures.sigma_um += std::pow(1e6 * static_cast<double>(sigma_m.at(x, y)), 2);
      figures.largest_um = std::max(figures.largest_um, std::abs(error));
      ++figures.points;
    }
  }
  figures.rms_um = std::sqrt(figures.rms_um / figures.points);
  figures.sigma_um = std::sqrt(figures.sigma_um / figures.points);
  return figures;
}

constexpr auto kEverywhere = [](int, int) { return true; };

TEST(SmoothHeights, MakesLessErrorAndSaysSoWithEveryWidthOfTheWeights) {
  WorkerPool pool(2);
  const auto tilted = [](int x, int y) { return 40.0 + 0.8 * x - 0.3 * y; };
  for (const int window : {1, 5, 9}) {
    const Map map = noisy(tilted, window);
    double before_um = figures_of(map.height_m, map.sigma_m, tilted, kEverywhere).rms_um;
    for (const double sigma_px : {1.0, 1.5, 2.0, 2.5, 4.0, 8.0}) {
      SCOPED_TRACE(testing::Message() << "window " << window << " px, smoothed by " << sigma_px << " px");
      const SmoothedHeights smooth =
          smooth_heights(map.height_m, map.sigma_m, {sigma_px, static_cast<double>(window * window), 30.0}, pool);
      const Figures figures = figures_of(smooth.height_m, smooth.sigma_m, tilted, kEverywhere);
      EXPECT_LT(figures.rms_um, before_um);
      EXPECT_NEAR(figures.sigma_um / figures.rms_um, 1.0, 0.25);
      before_um = figures.rms_um;
    }
  }
}

/// A wall that is jagged, with holes beside it.
TEST(SmoothHeights, StopsAtAWall) {
  WorkerPool pool(2);
  const auto wall = [](int y) { return 60 + y / 7 % 3; };
  const auto step = [&](int x, int y) { return 0.2 * y + (x < wall(y) ? 0.0 : 45.0); };
  Map map = noisy(step, 9);
  for (int y = 0; y < kSide; ++y) {
    for (int x = wall(y) - 3; x < wall(y) + 2; ++x) {
      map.height_m.at(x, y) = map.sigma_m.at(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  for (const double sigma_px : {2.0, 4.0, 8.0, 16.0}) {
    SCOPED_TRACE(sigma_px);
    const SmoothedHeights smooth = smooth_heights(map.height_m, map.sigma_m, {sigma_px, 81.0, 30.0}, pool);
    const Figures all = figures_of(smooth.height_m, smooth.sigma_m, step, kEverywhere);
    EXPECT_LT(all.largest_um, 6 * kNoise_um);
    const auto beside = [&](int x, int y) { return std::abs(x - wall(y)) < 20; };
    const Figures figures = figures_of(smooth.height_m, smooth.sigma_m, step, beside);
    EXPECT_LT(figures.rms_um, figures_of(map.height_m, map.sigma_m, step, beside).rms_um);
    EXPECT_NEAR(figures.sigma_um / figures.rms_um, 1.0, 0.4);
    EXPECT_EQ(figures.points, figures_of(map.height_m, map.sigma_m, step, beside).points);
  }
}

TEST(SmoothHeights, PassesBySingleWrongHeights) {
  WorkerPool pool(2);
  const auto flat = [](int, int) { return 40.0; };
  Map map = noisy(flat, 1);
  for (int y = 5; y < kSide; y += 10) {
    for (int x = 5; x < kSide; x += 10) map.height_m.at(x, y) = 90e-6F;
  }
  const SmoothedHeights smooth = smooth_heights(map.height_m, map.sigma_m, {3.0, 1.0, 30.0}, pool);
  const auto right = [](int x, int y) { return x % 10 != 5 || y % 10 != 5; };
  EXPECT_LT(figures_of(smooth.height_m, smooth.sigma_m, flat, right).largest_um, kNoise_um);
  EXPECT_EQ(smooth.height_m.at(15, 15), 90e-6F) << "nothing holds it";
}

TEST(SmoothHeights, PassesASlopeThatClimbsAJumpInAFewPixels) {
  WorkerPool pool(1);
  const auto steep = [](int x, int) { return 4.0 * x; };
  const Map map = noisy(steep, 9);
  const SmoothedHeights smooth = smooth_heights(map.height_m, map.sigma_m, {6.0, 81.0, 30.0}, pool);
  EXPECT_LT(figures_of(smooth.height_m, smooth.sigma_m, steep, kEverywhere).rms_um, 0.8 * kNoise_um);
}

TEST(SmoothHeights, RefusesWhatItCannotDo) {
  WorkerPool pool(1);
  const Map map;
  for (const SmoothSettings& settings :
       {SmoothSettings{0.5, 1.0, 1.0}, SmoothSettings{2.0, 0.5, 1.0}, SmoothSettings{2.0, 1.0, 0.0}}) {
    test::expect_error(ErrorCode::kBadInput, {"must be"},
                       [&] { (void)smooth_heights(map.height_m, map.sigma_m, settings, pool); });
  }
}

}  // namespace
}  // namespace fvd
