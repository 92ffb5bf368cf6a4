#include "core/metrology/profile/profile_evaluation.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/metrology/filter/profile_filter.hpp"

namespace fvd::metrology {
namespace {

using enum ProfileParameter;

double wave(double x_um, double wavelength_um) { return std::sin(2.0 * std::numbers::pi * x_um / wavelength_um); }

template <typename Height>
Profile profile_of(int points, double pitch_um, const Height& height) {
  Profile profile{{}, pitch_um};
  for (int i = 0; i < points; ++i) profile.z_um.push_back(height((i + 0.5) * pitch_um));
  return profile;
}

double only(const Profile& profile, ProfileParameter parameter, const ProfileSettings& settings) {
  const std::array<ProfileParameter, 1> asked{parameter};
  return evaluate_profile(profile, asked, settings).values.at(0).value.value();
}

TEST(ProfileEvaluation, PartsWavinessAndRoughnessAsTheReferenceCaseHasIt) {
  const Profile profile = profile_of(3200, 1.0, [](double x) { return 5.0 * wave(x, 800.0) + wave(x, 80.0); });
  for (const FilterMethod method : {FilterMethod::kGaussian, FilterMethod::kGaussianRegression1}) {
    const ProfileSettings settings{.nesting_um = 250.0, .method = method, .sections = 5, .section_length_um = 320.0};

    EXPECT_NEAR(only(profile, kRq, settings), 0.7432349, 1e-6);
    EXPECT_NEAR(only(profile, kWq, settings), 3.304133, 1e-6);
  }
}

TEST(ProfileEvaluation, PassesEachWaveOfTheReferenceCaseByItsShare) {
  const Profile profile = profile_of(3200, 1.0, [](double x) { return 5.0 * wave(x, 800.0) + wave(x, 80.0); });

  const FilteredProfile rest = filter_profile(profile.z_um, 1.0, {.side = FilterSide::kL, .nesting_um = 250.0});

  double share_of_long = 0.0;
  double share_of_short = 0.0;
  for (std::size_t i = 800; i < 2400; ++i) {  // whole periods of both
    const double x = static_cast<double>(i) + 0.5;
    share_of_long += rest.z_um[i] * wave(x, 800.0) / 800.0;
    share_of_short += rest.z_um[i] * wave(x, 80.0) / 800.0;
  }
  EXPECT_NEAR(share_of_long, 0.3272500, 1e-6);
  EXPECT_NEAR(share_of_short, 0.9988512, 1e-6);
}

TEST(ProfileEvaluation, OfASineHasItsClosedForms) {
  // The filter takes nothing of a wave this short; 3 um of slope are taken off P.
  const Profile profile = profile_of(2000, 0.1, [](double x) { return 2.0 * wave(x, 5.0) + 0.015 * x; });
  const ProfileSettings settings{.nesting_um = 20.0, .sections = 5, .section_length_um = 25.0};

  EXPECT_NEAR(only(profile, kRa, settings), 4.0 / std::numbers::pi, 1e-3);
  EXPECT_NEAR(only(profile, kRq, settings), std::numbers::sqrt2, 0.002);  // less its ends
  EXPECT_NEAR(only(profile, kRku, settings), 1.5, 1e-4);
  EXPECT_NEAR(only(profile, kRsk, settings), 0.0, 1e-4);
  EXPECT_NEAR(only(profile, kRt, settings), 4.0, 0.005);
  EXPECT_NEAR(only(profile, kRz, settings), 4.0, 0.005);
  EXPECT_NEAR(only(profile, kRp, settings), 2.0, 0.003);
  EXPECT_NEAR(only(profile, kRv, settings), 2.0, 0.003);
  EXPECT_NEAR(only(profile, kRSm, settings), 5.0, 1e-3);
  EXPECT_NEAR(only(profile, kRc, settings), 4.0, 0.005);
  EXPECT_NEAR(only(profile, kRdq, settings), 2.0 * 2.0 * std::numbers::pi / 5.0 / std::numbers::sqrt2,
              0.002);  // less its ends
  EXPECT_NEAR(only(profile, kRk, settings), 2.0 * 8.637288 / 5.0, 0.01);
  EXPECT_NEAR(only(profile, kRmr2, settings), 75.93, 2.5);  // 50 points a period
  EXPECT_NEAR(only(profile, kPq, settings), std::numbers::sqrt2, 0.02);
  EXPECT_NEAR(only(profile, kPku, settings), 1.5, 0.02);
  EXPECT_NEAR(only(profile, kPz, settings), 4.0, 0.2);
  EXPECT_EQ(only(profile, kPz, settings), only(profile, kPt, settings));
}

TEST(ProfileEvaluation, SumsHeightsOfEachSection) {
  // Long nesting index, three spikes: up in the first section, down in the second, both in the third.
  Profile profile = profile_of(300, 1.0, [](double) { return 0.0; });
  profile.z_um[20] = 6.0;
  profile.z_um[150] = -9.0;
  profile.z_um[230] = 12.0;
  profile.z_um[260] = -3.0;
  const ProfileSettings settings{.nesting_um = 100.0, .robust = true, .sections = 3};

  EXPECT_NEAR(only(profile, kRp, settings), (6.0 + 0.0 + 12.0) / 3.0, 1e-6);
  EXPECT_NEAR(only(profile, kRv, settings), (0.0 + 9.0 + 3.0) / 3.0, 1e-6);
  EXPECT_NEAR(only(profile, kRz, settings), 10.0, 1e-6);
  EXPECT_NEAR(only(profile, kRt, settings), 21.0, 1e-6);
  EXPECT_NEAR(only(profile, kRa, settings), 0.1, 1e-6);
  const double variance = (36.0 + 81.0 + 144.0 + 9.0) / 300.0;
  EXPECT_NEAR(only(profile, kRsk, settings), (216.0 - 729.0 + 1728.0 - 27.0) / 300.0 / (variance * std::sqrt(variance)),
              1e-5);
  EXPECT_NEAR(only(profile, kPt, settings), 21.0, 0.1);
}

TEST(ProfileEvaluation, SaysUnderWhichSettingsItsValuesStand) {
  const Profile profile = profile_of(5000, 1.0, [](double x) { return wave(x, 50.0); });
  const std::array<ProfileParameter, 2> asked{kRa, kRSm};

  const ProfileResult usual = evaluate_profile(profile, asked, {.nesting_um = 800.0});
  const ProfileResult fine = evaluate_profile(profile, asked, {.nesting_um = 80.0});
  const ProfileResult tolerated = evaluate_profile(profile, asked, {.nesting_um = 800.0, .tolerance_ra_um = 0.05});

  EXPECT_EQ(usual.default_settings, true);
  EXPECT_EQ(usual.label_suffix, "");
  EXPECT_EQ(usual.evaluation_length_um, 4000.0);
  EXPECT_EQ(usual.points, 4000u);
  EXPECT_EQ(usual.valid_fraction, 1.0);
  ASSERT_TRUE(usual.filter);
  EXPECT_EQ(usual.filter->nesting_px_x, 800.0);
  EXPECT_NEAR(*usual.height_discrimination_hill_um, 0.1, 0.002);
  EXPECT_NEAR(*usual.length_discrimination_um, 8.0, 1e-12);
  EXPECT_EQ(fine.default_settings, false);
  EXPECT_EQ(fine.label_suffix, " (0.08 mm x 5)");
  EXPECT_EQ(tolerated.default_settings, false);
}

TEST(ProfileEvaluation, GivesTheSameMirrored) {
  std::mt19937 random(21);
  std::normal_distribution<double> noise(0.0, 0.3);
  Profile profile = profile_of(600, 0.7, [&](double x) { return wave(x, 30.0) + noise(random); });
  profile.z_um[200] = profile.z_um[201] = std::nan("");
  const Profile mirrored{{profile.z_um.rbegin(), profile.z_um.rend()}, 0.7};
  const ProfileSettings settings{.nesting_um = 60.0};

  for (const ProfileParameterInfo& info : profile_parameters()) {
    const double value = only(profile, info.parameter, settings);
    EXPECT_NEAR(only(mirrored, info.parameter, settings), value, 1e-11 * (1.0 + std::abs(value))) << info.name;
  }
}

TEST(ProfileParameters, AreReadBackByName) {
  for (const ProfileParameterInfo& info : profile_parameters()) {
    EXPECT_EQ(profile_parameter_from_name(info.name), info.parameter);
    EXPECT_EQ(profile_parameter_info(info.parameter).name, info.name);
  }
  EXPECT_EQ(profile_parameter_info(kRmr1).suffix, "_percent");
  EXPECT_EQ(profile_parameter_info(kRSm).suffix, "_um");
  EXPECT_EQ(profile_parameter_info(kRdq).suffix, "");
  EXPECT_FALSE(profile_parameter_from_name("Sa"));
}

}  // namespace
}  // namespace fvd::metrology
