#include "core/focus/judge/slice_drift.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/focus/judge/judged_scene.hpp"

namespace fvd {
namespace {

constexpr int kSide = 240;
constexpr double kStep_um = 10.0;

/// A texture of waves that can be moved, scaled and blurred without error.
class Waves {
 public:
  explicit Waves(double contrast) : amplitude_(contrast) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < 30; ++i) {
      const double frequency = 2.0 * M_PI / (4.0 + 16.0 * uniform(random));
      const double angle = 2.0 * M_PI * uniform(random);
      waves_.push_back({frequency * std::cos(angle), frequency * std::sin(angle), 2.0 * M_PI * uniform(random)});
    }
  }

  /// About the middle of the image; blur_px: standard deviation.
  [[nodiscard]] test::Image image(double x_px, double y_px, double scale, double blur_px, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    test::Image image = test::Image::unset(kSide, kSide);
    std::vector<double> share;
    for (const Wave& wave : waves_) {
      share.push_back(amplitude_ * std::sqrt(2.0 / static_cast<double>(waves_.size())) *
                      std::exp(-0.5 * blur_px * blur_px * (wave.x * wave.x + wave.y * wave.y)));
    }
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double u = (x + 0.5 - kSide / 2 - x_px) / scale;
        const double v = (y + 0.5 - kSide / 2 - y_px) / scale;
        double level = 110.0 + noise(random);
        for (std::size_t i = 0; i < waves_.size(); ++i) {
          level += share[i] * std::cos(waves_[i].x * u + waves_[i].y * v + waves_[i].phase);
        }
        image.at(x, y) = test::grey(level);
      }
    }
    return image;
  }

 private:
  struct Wave {
    double x;
    double y;
    double phase;
  };
  double amplitude_;
  std::vector<Wave> waves_;
};

SlicePatches patches_of(const test::Image& image) {
  return slice_patches(image_view(image.view(), PixelFormat::kMono8));
}

/// Seven slices, in focus at the middle one.
DriftMeter measured(double x_px, double y_px, double growth, double contrast = 25.0) {
  const Waves waves(contrast);
  DriftMeter meter;
  for (int k = 0; k < 7; ++k) {
    meter.add(patches_of(waves.image(x_px * k, y_px * k, 1.0 + growth * k, 0.7 * std::abs(k - 3),
                                     static_cast<std::uint64_t>(k))),
              kStep_um * k);
  }
  return meter;
}

TEST(DriftMeter, FindsAFractionOfAPixelPerSlice) {
  const DriftMeter meter = measured(0.44, -0.23, 0.0);

  const auto figures = meter.figures();

  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->x_px, 6 * 0.44, 0.2);
  EXPECT_NEAR(figures->y_px, 6 * -0.23, 0.2);
  EXPECT_NEAR(figures->x_px_per_um, 0.044, 0.003);
  EXPECT_NEAR(figures->y_px_per_um, -0.023, 0.003);
  EXPECT_NEAR(figures->scale_per_um.value(), 0.0, 3e-5);
}

TEST(DriftMeter, FindsSeveralPixelsPerSlice) {
  const auto figures = measured(-3.3, 4.2, 0.0).figures();

  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->x_px_per_um, -0.33, 0.003);
  EXPECT_NEAR(figures->y_px_per_um, 0.42, 0.003);
}

TEST(DriftMeter, TellsGrowthFromDrift) {
  const auto figures = measured(0.3, 0.0, 0.002).figures();

  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->scale_per_um.value(), 0.0002, 3e-5);
  EXPECT_NEAR(figures->x_px_per_um, 0.03, 0.003);
  EXPECT_NEAR(figures->y_px_per_um, 0.0, 0.003);
}

TEST(DriftMeter, PutsTheMiddleSliceWhereItIs) {
  const DriftPath path = measured(0.5, 0.0, 0.0).path();

  EXPECT_NEAR(path.at(0.0).x_px, -1.5, 0.1);
  EXPECT_EQ(path.at(30.0).x_px, 0.0);
  EXPECT_NEAR(path.at(61.0).x_px, 1.5, 0.1);
}

TEST(DriftMeter, SaysNothingOfSlicesWithoutTexture) {
  const DriftMeter meter = measured(0.4, 0.0, 0.0, 0.0);

  EXPECT_FALSE(meter.figures());
  EXPECT_TRUE(meter.path().empty());
}

TEST(DriftMeter, PassesOverASliceWithoutTexture) {
  const Waves waves(25.0);
  DriftMeter meter;
  for (int k = 0; k < 7; ++k) {
    const test::Image image = k == 4 ? test::Image(kSide, kSide, 9) : waves.image(0.6 * k, 0.0, 1.0, 1.0, 5);
    meter.add(patches_of(image), kStep_um * k);
  }

  EXPECT_NEAR(meter.figures()->x_px, 6 * 0.6, 0.1);
  EXPECT_NEAR(meter.path().at(60.0).x_px, 3 * 0.6, 0.1);
}

TEST(DriftMeter, SeesNoDriftInCleanScans) {
  for (const double tilt : {0.0, 0.3, 0.8}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      test::SceneSettings settings;
      settings.tilt_x_um_per_px = tilt;
      settings.seed = seed;
      const test::Scene scene(settings);
      DriftMeter meter;
      for (std::size_t k = 0; k < scene.slices.size(); ++k) meter.add(slice_patches(scene.view(k)), scene.z_um[k]);

      const auto figures = meter.figures();

      ASSERT_TRUE(figures);
      EXPECT_NEAR(figures->x_px, 0.0, 0.4) << tilt;
      EXPECT_NEAR(figures->y_px, 0.0, 0.4) << tilt;
      EXPECT_NEAR(figures->scale_per_um.value(), 0.0, 3.0 * figures->scale_error_per_um + 1e-5) << tilt;
    }
  }
}

TEST(SlicePatches, AreNoneOfASmallImage) {
  const Plane<std::uint8_t> image(63, 200, 7);

  EXPECT_TRUE(slice_patches(image_view(image.view(), PixelFormat::kMono8)).values.empty());
}

TEST(SlicePatches, AreOfOneScaleForEightAndTwelveBits) {
  const test::Image image = Waves(40.0).image(0.0, 0.0, 1.0, 0.0, 1);
  Plane<std::uint16_t> wide = Plane<std::uint16_t>::unset(kSide, kSide);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) wide.at(x, y) = static_cast<std::uint16_t>(16 * image.at(x, y));
  }

  EXPECT_EQ(patches_of(image).values, slice_patches(image_view(wide.view(), PixelFormat::kMono12)).values);
}

}  // namespace
}  // namespace fvd
