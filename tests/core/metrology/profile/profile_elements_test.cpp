#include "core/metrology/profile/profile_elements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();
constexpr ElementDiscrimination kLeast{0.1, 0.1, 1.0};

std::vector<double> sine(int points, double wavelength, double height) {
  std::vector<double> z;
  for (int i = 0; i < points; ++i) z.push_back(height * std::sin(2.0 * std::numbers::pi * (i + 0.3) / wavelength));
  return z;
}

TEST(ProfileElements, OfASineAreItsPeriods) {
  const ProfileElements elements = find_profile_elements(sine(500, 50.0, 2.0), 0.5, kLeast);

  EXPECT_EQ(elements.crossings, 19u);
  EXPECT_EQ(elements.elements, 17u);  // complete hills and dales: 18 between crossings, in pairs
  EXPECT_NEAR(*elements.mean_length_um, 25.0, 1e-3);
  EXPECT_NEAR(*elements.mean_height_um, 4.0, 0.01);
}

TEST(ProfileElements, AreFoundInHandMadeHeights) {
  // Crossings at 0.5, 2.5, 5.5, 6.5 points.
  const std::vector<double> z{-1, 1, 1, -1, -3, -1, 1, -1};

  const ProfileElements elements = find_profile_elements(z, 1.0, {0.0, 0.0, 0.0});

  EXPECT_EQ(elements.crossings, 4u);
  EXPECT_EQ(elements.elements, 2u);  // 0.5 to 5.5 and 2.5 to 6.5
  EXPECT_NEAR(*elements.mean_length_um, 4.5, 1e-12);
  EXPECT_NEAR(*elements.mean_height_um, 4.0, 1e-12);
}

TEST(ProfileElements, DoNotCountWhatStaysBelowTheDiscriminations) {
  std::vector<double> z = sine(500, 50.0, 2.0);
  const ProfileElements clean = find_profile_elements(z, 1.0, kLeast);
  z[112] = -0.05;  // dents in a hill that are too shallow
  z[113] = 0.05;
  z[114] = -0.05;
  const ProfileElements shallow = find_profile_elements(z, 1.0, kLeast);
  z[112] = -1.0;  // deep, but too short
  const ProfileElements narrow = find_profile_elements(z, 1.0, {0.1, 0.1, 4.0});
  const ProfileElements counted = find_profile_elements(z, 1.0, {0.1, 0.1, 0.1});

  EXPECT_EQ(shallow.elements, clean.elements);
  EXPECT_DOUBLE_EQ(*shallow.mean_length_um, *clean.mean_length_um);
  EXPECT_EQ(narrow.elements, clean.elements);
  EXPECT_EQ(counted.elements, clean.elements + 2);
}

TEST(ProfileElements, HaveADiscriminationOfTheirOwnForHillsAndForDales) {
  const std::vector<double> low_hills{-1, 0.2, -1, 0.2, -1, 0.2, -1};

  EXPECT_EQ(find_profile_elements(low_hills, 1.0, {0.3, 0.1, 0.0}).crossings, 0u);
  EXPECT_EQ(find_profile_elements(low_hills, 1.0, {0.1, 0.3, 0.0}).crossings, 6u);
}

TEST(ProfileElements, TakeTheMiddleOfCrossingsThatNoiseRepeats) {
  const std::vector<double> z{-2, 2, 2, 2, 0.01, -0.01, 0.01, -2, -2, -2, 2, 2, -2};

  const ProfileElements elements = find_profile_elements(z, 1.0, {0.1, 0.1, 0.0});

  ASSERT_EQ(elements.crossings, 4u);
  const double middle = 0.5 * (4.5 + (6.0 + 0.01 / 2.01));
  EXPECT_NEAR(*elements.mean_length_um, 0.5 * ((9.5 - 0.5) + (11.5 - middle)), 1e-12);
}

TEST(ProfileElements, AreTheSameMirroredAndTurnedOver) {
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 0.4);
  std::vector<double> z = sine(777, 43.0, 1.0);
  for (double& value : z) value += noise(random);
  z[300] = kHole;
  std::vector<double> mirrored(z.rbegin(), z.rend());
  std::vector<double> turned = z;
  for (double& value : turned) value = -value;

  const ProfileElements elements = find_profile_elements(z, 1.0, {0.3, 0.5, 2.0});
  const ProfileElements of_mirrored = find_profile_elements(mirrored, 1.0, {0.3, 0.5, 2.0});
  const ProfileElements of_turned = find_profile_elements(turned, 1.0, {0.5, 0.3, 2.0});

  ASSERT_GT(elements.elements, 20u);
  EXPECT_EQ(elements.elements, of_mirrored.elements);
  EXPECT_NEAR(*elements.mean_length_um, *of_mirrored.mean_length_um, 1e-11);
  EXPECT_EQ(elements.elements, of_turned.elements);
  EXPECT_NEAR(*elements.mean_height_um, *of_turned.mean_height_um, 1e-12);
}

TEST(ProfileElements, EndAtHoles) {
  std::vector<double> z = sine(100, 20.0, 1.0);
  const std::size_t whole = find_profile_elements(z, 1.0, kLeast).elements;
  z[45] = kHole;
  const ProfileElements parted = find_profile_elements(z, 1.0, kLeast);
  std::fill(z.begin(), z.end(), 1.0);
  const ProfileElements none = find_profile_elements(z, 1.0, kLeast);

  EXPECT_EQ(whole, 7u);
  EXPECT_EQ(parted.elements, 2u + 3u);  // crossings at 10 to 40 and at 50 to 90 points
  EXPECT_NEAR(*parted.mean_length_um, 20.0, 0.02);
  EXPECT_EQ(none.crossings, 0u);
  EXPECT_FALSE(none.mean_length_um);
}

}  // namespace
}  // namespace fvd::metrology
