#include "core/metrology/uncertainty/random_normal.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

TEST(RandomNormal, BeginsWithTheBitsOfThePublishedGenerators) {
  RandomNormal first(1);
  RandomNormal of_a_stream(7, 3);

  // By a Python program of splitmix64 and xoshiro256++ that gives the published values for the state 1, 2, 3, 4.
  EXPECT_EQ(first.bits(), 0x8d6176e2f1f41696U);
  EXPECT_EQ(first.bits(), 0x4488d4fc02c8f1e9U);
  EXPECT_EQ(first.bits(), 0x0f2c0ec18a408301U);
  EXPECT_EQ(of_a_stream.bits(), 0x5b0b0b4967e7655aU);
  EXPECT_EQ(of_a_stream.bits(), 0x70e46aebd015637aU);
}

TEST(RandomNormal, BeginsWithFixedValues) {
  RandomNormal first(1);
  RandomNormal of_a_stream(7, 3);

  // By the same program; the logarithm of another library may differ by its last bit.
  EXPECT_NEAR(first.normal(), 0.3781836583484009, 1e-14);
  EXPECT_NEAR(first.normal(), -1.680692806618654, 1e-14);
  EXPECT_NEAR(first.normal(), -0.3567184303346632, 1e-14);
  EXPECT_NEAR(first.normal(), -0.15669408100586965, 1e-14);
  EXPECT_NEAR(of_a_stream.normal(), -1.9981999111819952, 1e-14);
  EXPECT_NEAR(of_a_stream.normal(), -0.8168522038794879, 1e-14);
}

TEST(RandomNormal, HasTheMomentsOfTheNormalDistribution) {
  constexpr int kDraws = 1'000'000;
  RandomNormal random(3);
  double mean = 0.0;
  double square = 0.0;
  double cube = 0.0;
  double fourth = 0.0;
  double with_next = 0.0;
  int outside = 0;  // of +-1.959964
  double before = 0.0;

  for (int i = 0; i < kDraws; ++i) {
    const double value = random.normal();
    mean += value / kDraws;
    square += value * value / kDraws;
    cube += value * value * value / kDraws;
    fourth += value * value * value * value / kDraws;
    with_next += before * value / kDraws;
    outside += std::abs(value) > 1.959963985 ? 1 : 0;
    before = value;
  }

  // Four standard errors each.
  EXPECT_NEAR(mean, 0.0, 0.004);
  EXPECT_NEAR(square, 1.0, 0.0057);
  EXPECT_NEAR(cube, 0.0, 0.0155);
  EXPECT_NEAR(fourth, 3.0, 0.0392);
  EXPECT_NEAR(with_next, 0.0, 0.004);
  EXPECT_NEAR(outside, 50'000, 872);
}

TEST(RandomNormal, IsUniformBelowOne) {
  RandomNormal random(5);
  double mean = 0.0;
  double square = 0.0;

  for (int i = 0; i < 100'000; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    mean += value / 100'000;
    square += value * value / 100'000;
  }

  EXPECT_NEAR(mean, 0.5, 0.0037);
  EXPECT_NEAR(square, 1.0 / 3.0, 0.0038);
}

TEST(RandomNormal, GivesEverySeedAndStreamItsOwnSequence) {
  RandomNormal a(1, 1);
  RandomNormal b(2, 0);
  RandomNormal c(1, 2);
  double a_b = 0.0;
  double a_c = 0.0;

  for (int i = 0; i < 10'000; ++i) {
    const double of_a = a.normal();
    a_b += of_a * b.normal() / 10'000;
    a_c += of_a * c.normal() / 10'000;
  }

  EXPECT_NEAR(a_b, 0.0, 0.04);
  EXPECT_NEAR(a_c, 0.0, 0.04);
}

}  // namespace
}  // namespace fvd::metrology
