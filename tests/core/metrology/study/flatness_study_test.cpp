#include "core/metrology/study/flatness_study.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/core/metrology/study/scans.hpp"

namespace fvd::metrology {
namespace {

using testing::add_plane;
using testing::pointers;
using testing::scan;

constexpr int kWidth = 80;
constexpr int kHeight = 60;

/// Whole waves along both axes: orthogonal to 1 and of mirrored symmetry, so that no plane is in it. Range 0.2.
double form_um(int x, int y) {
  return 0.05 * std::cos(2.0 * M_PI * (x + 0.5) / kWidth) + 0.05 * std::cos(4.0 * M_PI * (y + 0.5) / kHeight);
}

HeightField flat(std::uint64_t seed, double noise_um) {
  HeightField field = scan(kWidth, kHeight, seed, noise_um);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) field.z_um.at(x, y) += form_um(x, y);
  }
  add_plane(field, 0.7 * static_cast<double>(seed), 0.001 * static_cast<double>(seed), -0.003);
  field.kernel = {{0.25, 0.5, 0.25}};
  return field;
}

FlatnessStudy studied(std::span<const HeightField* const> maps, const Region& region = {}) {
  return std::get<FlatnessStudy>(flatness_deviation(maps, region));
}

double range_um() {
  double lowest = 1.0;
  double highest = -1.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      lowest = std::min(lowest, form_um(x, y));
      highest = std::max(highest, form_um(x, y));
    }
  }
  return highest - lowest;
}

TEST(FlatnessStudy, OfMapsWithoutNoiseIsTheirFormWithoutTheirPlanes) {
  std::vector<HeightField> maps;
  for (int i = 0; i < 3; ++i) maps.push_back(flat(static_cast<std::uint64_t>(i), 0.0));

  const FlatnessStudy study = studied(pointers(maps));

  EXPECT_NEAR(study.flatness_um, range_um(), 1e-12);
  EXPECT_EQ(study.positions, 3);
  EXPECT_EQ(study.points, kWidth * kHeight);
  EXPECT_EQ(study.valid_fraction, 1.0);
  EXPECT_EQ(study.reference.pitch_x_um, 0.5);
  EXPECT_EQ(study.reference.pitch_y_um, 0.4);
  EXPECT_EQ(study.reference.kernel.weights.size(), 3U);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_NEAR(study.reference.z_um.at(x, y), form_um(x, y), 1e-12);
      ASSERT_NEAR(study.reference.sigma_um.at(x, y), 0.0, 1e-9);
    }
  }
}

TEST(FlatnessStudy, OfOnePositionHasNoSigma) {
  std::vector<HeightField> maps;
  maps.push_back(flat(3, 0.0));

  const FlatnessStudy study = studied(pointers(maps));

  EXPECT_NEAR(study.flatness_um, range_um(), 1e-12);
  EXPECT_FALSE(study.reference.has_sigma());
}

TEST(FlatnessStudy, HasTheStandardErrorOfTheMean) {
  std::vector<HeightField> maps;
  for (int i = 0; i < 8; ++i) maps.push_back(flat(static_cast<std::uint64_t>(i), 0.2));

  const FlatnessStudy study = studied(pointers(maps));

  double stated = 0.0;
  double errors = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      stated += std::pow(static_cast<double>(study.reference.sigma_um.at(x, y)), 2) / (kWidth * kHeight);
      errors += std::pow(study.reference.z_um.at(x, y) - form_um(x, y), 2) / (kWidth * kHeight);
    }
  }
  EXPECT_NEAR(std::sqrt(stated), 0.2 / std::sqrt(8.0), 0.002);
  EXPECT_NEAR(std::sqrt(errors), 0.2 / std::sqrt(8.0), 0.003);
}

TEST(FlatnessStudy, HasHolesWhereOnePositionHas) {
  std::vector<HeightField> maps;
  for (int i = 0; i < 2; ++i) maps.push_back(flat(static_cast<std::uint64_t>(i), 0.0));
  maps[1].z_um.at(10, 20) = std::nan("");

  const FlatnessStudy study = studied(pointers(maps));

  EXPECT_EQ(study.points, kWidth * kHeight - 1);
  EXPECT_TRUE(study.reference.is_hole(10, 20));
  EXPECT_TRUE(std::isnan(study.reference.sigma_um.at(10, 20)));
  EXPECT_FALSE(study.reference.is_hole(11, 20));
}

TEST(FlatnessStudy, LooksAtItsRegionOnly) {
  std::vector<HeightField> maps;
  maps.push_back(flat(2, 0.0));
  Region region(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y) region.at(5, y) = 0;
  maps[0].z_um.at(5, 9) += 100.0;

  const FlatnessStudy study = studied(pointers(maps), region);

  EXPECT_EQ(study.points, (kWidth - 1) * kHeight);
  EXPECT_NEAR(study.flatness_um, range_um(), 0.005);
  EXPECT_GT(study.reference.z_um.at(5, 9), 99.0);
}

TEST(FlatnessStudy, IsRefusedOverTooFewPoints) {
  std::vector<HeightField> maps;
  maps.push_back(scan(9, 11, 1, 0.1));

  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(flatness_deviation(pointers(maps))));
  EXPECT_THROW(static_cast<void>(flatness_deviation({})), Error);
}

TEST(FlatnessStudy, IsRefusedOverALine) {
  std::vector<HeightField> maps;
  maps.push_back(scan(200, 1, 1, 0.1));

  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(flatness_deviation(pointers(maps))));
}

}  // namespace
}  // namespace fvd::metrology
