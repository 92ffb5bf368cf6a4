#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/profile/profile_evaluation.hpp"

namespace fvd::metrology {
namespace {

using enum ProfileParameter;

Profile rough(int points) {
  Profile profile{{}, 1.0};
  for (int i = 0; i < points; ++i) profile.z_um.push_back(std::sin(2.0 * std::numbers::pi * (i + 0.5) / 20.0));
  return profile;
}

ProfileValue only(const Profile& profile, ProfileParameter parameter, const ProfileSettings& settings) {
  const std::array<ProfileParameter, 1> asked{parameter};
  return evaluate_profile(profile, asked, settings).values.at(0);
}

void expect_refused(const ProfileValue& value, ProfileReason reason) {
  EXPECT_FALSE(value.value);
  EXPECT_EQ(value.reason, reason) << profile_reason_name(value.reason);
  EXPECT_FALSE(value.detail.empty());
}

TEST(ProfileReasons, TellThatTheProfileIsTooShort) {
  const Profile profile = rough(460);

  expect_refused(only(profile, kRa, {.nesting_um = 100.0}), ProfileReason::kEvaluationLength);
  expect_refused(only(profile, kPa, {.nesting_um = 100.0}), ProfileReason::kEvaluationLength);
  EXPECT_TRUE(only(profile, kRa, {.nesting_um = 80.0}).value);
  // The mean leaves 380 of 460 um.
  expect_refused(only(profile, kRa, {.nesting_um = 80.0, .method = FilterMethod::kGaussian}),
                 ProfileReason::kEvaluationLength);
}

TEST(ProfileReasons, TellThatAHoleIsTooLong) {
  Profile profile = rough(460);
  for (std::size_t i = 200; i < 220; ++i) profile.z_um[i] = std::nan("");
  EXPECT_TRUE(only(profile, kRa, {.nesting_um = 80.0}).value);
  EXPECT_TRUE(only(profile, kPa, {.nesting_um = 80.0}).value);

  profile.z_um[220] = std::nan("");

  expect_refused(only(profile, kRa, {.nesting_um = 80.0}), ProfileReason::kHoleTooLong);
  expect_refused(only(profile, kRz, {.nesting_um = 80.0}), ProfileReason::kHoleTooLong);
  expect_refused(only(profile, kPa, {.nesting_um = 80.0}), ProfileReason::kHoleTooLong);
  const std::array<ProfileParameter, 1> asked{kRa};
  EXPECT_EQ(evaluate_profile(profile, asked, {.nesting_um = 80.0}).longest_hole_um, 21.0);
  EXPECT_NEAR(evaluate_profile(profile, asked, {.nesting_um = 80.0}).valid_fraction, 379.0 / 400.0, 1e-12);
}

TEST(ProfileReasons, TellThatTheFilterIsRefused) {
  const Profile profile = rough(460);

  expect_refused(only(profile, kRa, {.nesting_um = 4.0}), ProfileReason::kFilter);
  expect_refused(only(profile, kRa, {}), ProfileReason::kFilter);
  EXPECT_TRUE(only(profile, kPa, {}).value);
}

TEST(ProfileReasons, TellThatAShapeIsThatOfNoise) {
  const Profile profile = rough(460);

  expect_refused(only(profile, kRsk, {.nesting_um = 80.0, .noise_floor_um = 0.8}), ProfileReason::kBelowNoise);
  EXPECT_TRUE(only(profile, kRku, {.nesting_um = 80.0, .noise_floor_um = 0.6}).value);
  EXPECT_TRUE(only(profile, kRa, {.nesting_um = 80.0, .noise_floor_um = 0.8}).value);
  const Profile flat{std::vector<double>(460, 0.0), 1.0};
  expect_refused(only(flat, kRku, {.nesting_um = 80.0}), ProfileReason::kFlat);
  EXPECT_EQ(only(flat, kRa, {.nesting_um = 80.0}).value, 0.0);
}

TEST(ProfileReasons, TellThatNothingIsCrossedOrComplete) {
  const Profile flat{std::vector<double>(460, 0.0), 1.0};
  expect_refused(only(flat, kRSm, {.nesting_um = 80.0}), ProfileReason::kNoCrossing);
  Profile holes = rough(460);
  for (std::size_t i = 0; i < 460; i += 12) holes.z_um[i] = std::nan("");

  expect_refused(only(holes, kRSm, {.nesting_um = 80.0}), ProfileReason::kNoElement);
  expect_refused(only(holes, kRc, {.nesting_um = 80.0}), ProfileReason::kNoElement);
  EXPECT_TRUE(only(holes, kRa, {.nesting_um = 80.0}).value);
}

TEST(ProfileReasons, TellThatPointsAreTooFew) {
  const Profile profile = rough(90);

  expect_refused(only(profile, kRk, {.nesting_um = 15.0}), ProfileReason::kTooFewPoints);
  EXPECT_TRUE(only(profile, kRa, {.nesting_um = 15.0}).value);
}

TEST(ProfileReasons, AreNoneForWhatBreaksTheRules) {
  EXPECT_THROW((void)only({{}, 1.0}, kRa, {.nesting_um = 80.0}), Error);
  EXPECT_THROW((void)only(rough(100), kRa, {.nesting_um = 10.0, .sections = 0}), Error);
  EXPECT_THROW((void)only(rough(100), kRa, {.nesting_um = -10.0}), Error);
  EXPECT_THROW((void)only(rough(100), kRa, {.nesting_um = 10.0, .section_length_um = 0.0}), Error);
}

}  // namespace
}  // namespace fvd::metrology
