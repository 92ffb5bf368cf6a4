#include "core/metrology/uncertainty/noise_map.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/uncertainty/noisy_fields.hpp"

namespace fvd::metrology {
namespace {

using testing::box;
using testing::correlation_along;
using testing::double_box;
using testing::uneven_field;

Plane<double> drawn(NoiseMaps& noise, const HeightField& field, std::uint64_t draw) {
  Plane<double> z_um(field.width(), field.height(), -1.0);
  noise.add_to_heights(draw, z_um);
  return z_um;
}

bool same_bytes(const Plane<double>& a, const Plane<double>& b) {
  return std::memcmp(a.row(0), b.row(0), a.pixels().size_bytes()) == 0;
}

TEST(NoiseMaps, GivesTheSameDrawTheSameBytes) {
  const HeightField field = uneven_field(20, 15, box(5), true);
  NoiseMaps first(field, 4);
  NoiseMaps second(field, 4);

  const Plane<double> seven = drawn(first, field, 7);
  const Plane<double> three = drawn(second, field, 3);
  const Plane<double> seven_later = drawn(second, field, 7);

  EXPECT_TRUE(same_bytes(seven, seven_later));
  EXPECT_FALSE(same_bytes(seven, three));
}

TEST(NoiseMaps, OfAnotherSeedAreOthers) {
  const HeightField field = uneven_field(20, 15, box(5), false);
  NoiseMaps first(field, 4);
  NoiseMaps second(field, 5);

  EXPECT_FALSE(same_bytes(drawn(first, field, 0), drawn(second, field, 0)));
  EXPECT_FALSE(same_bytes(drawn(first, field, 1), drawn(second, field, 0)));
}

TEST(NoiseMaps, LeavesHolesAndOnlyHoles) {
  const HeightField field = uneven_field(20, 15, box(5), true);
  NoiseMaps noise(field, 4);

  const Plane<double> z_um = drawn(noise, field, 0);

  for (int y = 0; y < 15; ++y) {
    for (int x = 0; x < 20; ++x) EXPECT_EQ(std::isnan(z_um.at(x, y)), field.is_hole(x, y));
  }
}

TEST(NoiseMaps, HasTheStandardDeviationOfEachPointUpToTheBorder) {
  constexpr int kDraws = 3000;
  const HeightField field = uneven_field(12, 10, double_box(5, 3), true);
  NoiseMaps noise(field, 9);
  Plane<double> mean(12, 10);
  Plane<double> square(12, 10);

  for (int draw = 0; draw < kDraws; ++draw) {
    const Plane<double> z_um = drawn(noise, field, static_cast<std::uint64_t>(draw));
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 12; ++x) {
        const double error = z_um.at(x, y) - field.z_um.at(x, y);
        mean.at(x, y) += error / kDraws;
        square.at(x, y) += error * error / kDraws;
      }
    }
  }

  // The standard deviation of 3000 draws is known to 1.3 %, their mean to 0.018 of it; four times that.
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 12; ++x) {
      if (field.is_hole(x, y)) continue;
      const double sigma = testing::uneven_sigma_um(x, y);
      EXPECT_NEAR(std::sqrt(square.at(x, y)) / sigma, 1.0, 0.052) << x << " " << y;
      EXPECT_NEAR(mean.at(x, y) / sigma, 0.0, 0.073) << x << " " << y;
    }
  }
}

TEST(NoiseMaps, CorrelatesNeighboursAsTheKernelDoes) {
  for (const LateralKernel& kernel : {box(9), double_box(9, 5)}) {
    HeightField field = uneven_field(400, 400, kernel, false);
    for (float& sigma : field.sigma_um.pixels()) sigma = 0.5F;
    NoiseMaps noise(field, 2);

    const Plane<double> z_um = drawn(noise, field, 0);

    for (const auto& [dx, dy] : {std::array{1, 0}, {0, 1}, {4, 0}, {0, 4}, {3, 5}, {8, 0}, {0, 12}, {15, 15}}) {
      double sum = 0.0;
      int pairs = 0;
      for (int y = 0; y + dy < 400; ++y) {
        for (int x = 0; x + dx < 400; ++x) {
          const double here = z_um.at(x, y) - field.z_um.at(x, y);
          sum += here * (z_um.at(x + dx, y + dy) - field.z_um.at(x + dx, y + dy));
          ++pairs;
        }
      }
      const double expected = correlation_along(kernel, dx) * correlation_along(kernel, dy);
      EXPECT_NEAR(sum / pairs / 0.25, expected, 0.08) << kernel.weights.size() << " " << dx << " " << dy;
    }
  }
}

TEST(NoiseMaps, CannotBeDrawnWithoutSigma) {
  HeightField field = uneven_field(8, 8, box(3), false);
  field.sigma_um = {};

  EXPECT_THROW(NoiseMaps(field, 1), Error);
}

}  // namespace
}  // namespace fvd::metrology
