#include "core/metrology/real_fft.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

TEST(RealFft, GivesBackThePlaneThatWentIn) {
  RealFft fft(12, 5);
  for (std::size_t i = 0; i < fft.plane().size(); ++i) fft.plane()[i] = std::sin(static_cast<double>(i * i));
  const std::vector<double> before(fft.plane().begin(), fft.plane().end());

  fft.forward();
  std::fill(fft.plane().begin(), fft.plane().end(), 0.0);
  fft.inverse();

  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(fft.plane()[i], before[i], 1e-14);
}

TEST(RealFft, PutsAWaveAlongTheRowsIntoItsOneColumn) {
  constexpr int kWidth = 16;
  RealFft fft(kWidth, 4);
  for (std::size_t i = 0; i < fft.plane().size(); ++i) {
    fft.plane()[i] = std::cos(2.0 * std::numbers::pi * 3.0 * static_cast<double>(i % kWidth) / kWidth);
  }

  fft.forward();

  EXPECT_NEAR(fft.spectrum()[3].real(), 32.0, 1e-12);  // half of the points: the other half is the mirrored frequency
  EXPECT_NEAR(std::abs(fft.spectrum()[4]), 0.0, 1e-12);
}

TEST(RealFft, KnowsGoodSizes) {
  EXPECT_EQ(RealFft::good_size(1), 1);
  EXPECT_EQ(RealFft::good_size(11), 12);
  EXPECT_EQ(RealFft::good_size(343), 343);
  EXPECT_EQ(RealFft::good_size(361), 375);
}

}  // namespace
}  // namespace fvd::metrology
