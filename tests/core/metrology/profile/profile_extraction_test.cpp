#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/profile/profile.hpp"

namespace fvd::metrology {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

HeightField plane(int width, int height, double pitch_x_um, double pitch_y_um) {
  HeightField field{Plane<double>(width, height), {}, pitch_x_um, pitch_y_um, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) field.z_um.at(x, y) = 0.2 * field.x_um(x) - 0.7 * field.y_um(y);
  }
  return field;
}

TEST(ProfileExtraction, TakesThePointsOfARow) {
  const HeightField field = plane(50, 40, 0.5, 0.5);

  const Profile profile =
      extract_profile(field, {.from_x_um = 5.0, .from_y_um = 10.25, .to_x_um = 20.0, .to_y_um = 10.25});

  ASSERT_EQ(profile.z_um.size(), 30u);
  EXPECT_DOUBLE_EQ(profile.pitch_um, 0.5);
  for (int i = 0; i < 30; ++i) {
    EXPECT_DOUBLE_EQ(profile.z_um[static_cast<std::size_t>(i)], field.z_um.at(10 + i, 20));
  }
}

TEST(ProfileExtraction, GoesInAnyDirectionWithAnyPitch) {
  const HeightField field = plane(80, 60, 0.5, 0.8);

  const ProfileLine line{.from_x_um = 35.0, .from_y_um = 8.0, .to_x_um = 11.0, .to_y_um = 40.0, .band_width_um = 6.0};
  const Profile profile = extract_profile(field, line);

  // Direction (-0.6, 0.8).
  const double pitch = 1.0 / std::hypot(0.6 / 0.5, 0.8 / 0.8);
  EXPECT_EQ(profile.z_um.size(), static_cast<std::size_t>(std::lround(40.0 / pitch)));
  EXPECT_NEAR(profile.length_um(), 40.0, 1e-12);
  for (std::size_t i = 0; i < profile.z_um.size(); ++i) {
    const double along = (static_cast<double>(i) + 0.5) * profile.pitch_um;
    EXPECT_NEAR(profile.z_um[i], 0.2 * (35.0 - 0.6 * along) - 0.7 * (8.0 + 0.8 * along), 1e-12);
  }
}

TEST(ProfileExtraction, AveragesAcrossTheBandAlone) {
  HeightField field{Plane<double>(40, 40, 0.0), {}, 1.0, 1.0, {}};
  for (int x = 0; x < 40; ++x) {
    field.z_um.at(x, 16) = 9.0;  // the band's first row
    field.z_um.at(x, 15) = 500.0;
    field.z_um.at(x, 25) = 500.0;
  }

  const Profile profile = extract_profile(
      field, {.from_x_um = 4.0, .from_y_um = 20.5, .to_x_um = 36.0, .to_y_um = 20.5, .band_width_um = 9.0});

  EXPECT_NEAR(profile.z_um[10], 1.0, 1e-12);
}

TEST(ProfileExtraction, LaysTheBandAcrossASlantingLine) {
  HeightField field{Plane<double>(80, 80), {}, 1.0, 1.0, {}};
  const ProfileLine line{.from_x_um = 15.0, .from_y_um = 10.0, .to_x_um = 51.0, .to_y_um = 58.0, .band_width_um = 12.0};
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {
      const double away = 0.8 * (field.x_um(x) - 15.0) - 0.6 * (field.y_um(y) - 10.0);
      field.z_um.at(x, y) = away * away;
    }
  }

  const Profile profile = extract_profile(field, line);

  // 12 samples, 1 um apart; bilinear heights between points are at most 1/4 above such a parabola.
  for (const double z : profile.z_um) EXPECT_NEAR(z, (144.0 - 1.0) / 12.0 + 0.12, 0.14);
}

TEST(ProfileExtraction, MakesAHoleWhereANeighbourIsMissing) {
  HeightField field = plane(40, 40, 1.0, 1.0);
  field.z_um.at(20, 20) = kHole;
  ProfileLine line{.from_x_um = 4.0, .from_y_um = 20.0, .to_x_um = 36.0, .to_y_um = 20.0};  // between rows 19 and 20

  const Profile between = extract_profile(field, line);
  line.from_y_um = line.to_y_um = 19.5;
  const Profile on_a_row = extract_profile(field, line);
  line.band_width_um = 5.0;
  const Profile band = extract_profile(field, line);
  line.min_band_share = 0.8;
  const Profile partial = extract_profile(field, line);

  EXPECT_TRUE(std::isnan(between.z_um[16]));
  EXPECT_FALSE(std::isnan(between.z_um[15]));
  EXPECT_FALSE(std::isnan(between.z_um[17]));
  EXPECT_FALSE(std::isnan(on_a_row.z_um[16]));
  EXPECT_TRUE(std::isnan(band.z_um[16]));
  EXPECT_FALSE(std::isnan(partial.z_um[16]));
}

TEST(ProfileExtraction, HasHolesInTheOuterHalfPixelOfTheField) {
  const HeightField field = plane(40, 40, 1.0, 1.0);

  const Profile profile = extract_profile(field, {.from_x_um = 0.0, .from_y_um = 0.3, .to_x_um = 40.0, .to_y_um = 0.3});

  EXPECT_TRUE(std::isnan(profile.z_um[20]));
}

TEST(ProfileExtraction, OfPointsThatAreAskedForIsTheSame) {
  HeightField field = plane(80, 60, 0.1 + 0.2, 1.0 / 3.0);
  for (int i = 0; i < 40; ++i) field.z_um.at(7 * i % 80, 11 * i % 60) = kHole;
  std::set<std::pair<int, int>> asked;
  PointField points{80, 60, field.pitch_x_um, field.pitch_y_um, {}};
  points.z_um = [&](int column, int row) {
    EXPECT_TRUE(column >= 0 && column < 80 && row >= 0 && row < 60);
    asked.emplace(column, row);
    return field.z_um.at(column, row);
  };
  for (const double band_um : {0.0, 2.5}) {
    const ProfileLine line{
        .from_x_um = 20.0, .from_y_um = 3.0, .to_x_um = 4.0, .to_y_um = 11.0, .band_width_um = band_um};
    asked.clear();

    const Profile of_points = extract_profile(points, line);
    const Profile of_field = extract_profile(field, line);

    EXPECT_EQ(of_points.pitch_um, of_field.pitch_um);
    ASSERT_EQ(of_points.z_um.size(), of_field.z_um.size());
    for (std::size_t i = 0; i < of_field.z_um.size(); ++i) {
      const bool hole = std::isnan(of_field.z_um[i]);
      EXPECT_TRUE(hole ? std::isnan(of_points.z_um[i]) : of_points.z_um[i] == of_field.z_um[i]) << i;
    }
    EXPECT_LT(asked.size(), band_um > 0.0 ? 700U : 250U) << "what lies beside the line is not needed";
  }
}

TEST(ProfileExtraction, RefusesWhatLeavesTheField) {
  const HeightField field = plane(40, 40, 1.0, 1.0);
  const auto code_of = [&field](const ProfileLine& line) {
    try {
      (void)extract_profile(field, line);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::kInternal;
  };

  const ErrorCode outside = ErrorCode::kRegionOutside;
  EXPECT_EQ(code_of({.from_x_um = -1.0, .from_y_um = 5, .to_x_um = 20, .to_y_um = 5}), outside);
  EXPECT_EQ(code_of({.from_x_um = 1.0, .from_y_um = 5, .to_x_um = 20, .to_y_um = 41}), outside);
  EXPECT_EQ(code_of({.from_x_um = 1, .from_y_um = 5, .to_x_um = 20, .to_y_um = 5, .band_width_um = 11}), outside);
  EXPECT_NO_THROW(
      (void)extract_profile(field, {.from_x_um = 1, .from_y_um = 5, .to_x_um = 20, .to_y_um = 5, .band_width_um = 10}));
  EXPECT_EQ(code_of({.from_x_um = 1, .from_y_um = 5, .to_x_um = 1.5, .to_y_um = 5}), ErrorCode::kBadInput);
  EXPECT_EQ(code_of({.from_x_um = kHole, .from_y_um = 5, .to_x_um = 9, .to_y_um = 5}), ErrorCode::kBadInput);
}

}  // namespace
}  // namespace fvd::metrology
