#include "core/focus/measure/noise_probe.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace fvd {
namespace {

constexpr int kWidth = 384;
constexpr int kHeight = 256;

Plane<std::uint16_t> noisy(double level, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(level, sigma);
  Plane<std::uint16_t> slice = Plane<std::uint16_t>::unset(kWidth, kHeight);
  for (std::uint16_t& pixel : slice.pixels()) {
    pixel = static_cast<std::uint16_t>(std::clamp(std::lround(noise(random)), 0L, 4095L));
  }
  return slice;
}

/// The first `dark` slices have hardly any noise.
NoiseProbe probe_of(int slices, double sigma, int dark) {
  NoiseProbe probe(kWidth, kHeight);
  WorkerPool pool(1);
  for (int k = 0; k < slices; ++k) {
    const Plane<std::uint16_t> slice =
        noisy(k < dark ? 20.0 : 1000.0, k < dark ? 0.5 : sigma, static_cast<std::uint64_t>(k) + 1);
    probe.add(image_view(slice.view(), PixelFormat::kMono12), pool);
  }
  return probe;
}

TEST(NoiseProbe, TellsTheNoiseWhateverTheNumberOfSlices) {
  for (const int slices : {1, 3, 5, 8, 21, 60}) {
    const NoiseProbe probe = probe_of(slices, 12.0, 0);
    EXPECT_NEAR(probe.median(), 12.0, 0.04 * 12.0) << slices;
  }
}

TEST(NoiseProbe, DoesNotBelieveOneOrTwoDarkSlices) {
  for (const int slices : {8, 21, 60}) {
    const double clean = probe_of(slices, 12.0, 0).median();
    EXPECT_NEAR(probe_of(slices, 12.0, 1).median(), clean, 0.04 * clean) << slices;
    EXPECT_NEAR(probe_of(slices, 12.0, 2).median(), clean, 0.07 * clean) << slices;
  }
  EXPECT_NEAR(probe_of(5, 12.0, 1).median(), 12.0, 0.07 * 12.0);
}

}  // namespace
}  // namespace fvd
