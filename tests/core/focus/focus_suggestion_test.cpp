#include "core/focus/focus_suggestion.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "core/base/error.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

/// Waves of a period in both directions on the right, bare on the left.
Plane<std::uint8_t> waves(double period_px, double amplitude, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, noise);
  Plane<std::uint8_t> image(400, 300);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) {
      const double phase = 2.0 * std::numbers::pi / period_px;
      const double wave = x < 140 ? 0.0 : amplitude * std::sin(phase * x) * std::sin(phase * y);
      image.at(x, y) = static_cast<std::uint8_t>(std::lround(128.0 + wave + normal(random)));
    }
  }
  return image;
}

FocusSuggestion suggest(const Plane<std::uint8_t>& image) {
  return suggest_focus(image_view(image.view(), PixelFormat::kMono8));
}

TEST(FocusSuggestion, LeavesTheDefaultsWhereNoiseIsSmallAgainstTheTexture) {
  for (const double period_px : {3.0, 5.0, 8.0, 14.0}) {
    const FocusSuggestion suggestion = suggest(waves(period_px, 60.0, 0.5));
    EXPECT_EQ(suggestion.distance_px, FocusSettings{}.distance_px) << period_px;
    EXPECT_EQ(suggestion.window_px, FocusSettings{}.window_px) << period_px;
    EXPECT_LE(suggestion.sample_noise, 0.03) << period_px;
  }
}

TEST(FocusSuggestion, AsksForALargerWindowWhereNoiseIsLargeAgainstTheTexture) {
  const FocusSuggestion noisy = suggest(waves(6.0, 12.0, 2.5));
  EXPECT_NEAR(noisy.noise_grey, 2.5, 0.3);
  EXPECT_EQ(noisy.distance_px, 2);
  EXPECT_GT(noisy.window_px, 9);
  EXPECT_LE(noisy.sample_noise, 0.03);
}

TEST(FocusSuggestion, AsksForFartherNeighboursWhereNoiseIsLargeAndTheTextureCoarse) {
  const FocusSuggestion coarse = suggest(waves(40.0, 40.0, 1.5));
  EXPECT_GT(coarse.distance_px, 3);
  EXPECT_LE(coarse.sample_noise, 0.03);
}

TEST(FocusSuggestion, TakesTheNoiseFromOutside) {
  const Plane<std::uint8_t> image = waves(3.0, 40.0, 0.0);
  const FocusSuggestion suggestion = suggest_focus(image_view(image.view(), PixelFormat::kMono8), 4.0);
  EXPECT_EQ(suggestion.noise_grey, 4.0);
  EXPECT_GT(suggestion.window_px, 9);
}

TEST(FocusSuggestion, RefusesAnImageThatShowsNothing) {
  EXPECT_THROW(suggest(waves(6.0, 0.0, 2.0)), Error);
  EXPECT_THROW(suggest(Plane<std::uint8_t>(400, 300, 90)), Error);
  EXPECT_THROW(suggest(Plane<std::uint8_t>(31, 300, 90)), Error);
}

}  // namespace
}  // namespace fvd
