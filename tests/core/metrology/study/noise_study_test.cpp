#include "core/metrology/study/noise_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/metrology/uncertainty/noise_map.hpp"
#include "tests/core/metrology/study/scans.hpp"

namespace fvd::metrology {
namespace {

using testing::add_plane;
using testing::pointers;
using testing::scan;

NoiseStudy studied(std::span<const HeightField* const> scans, const Region& region = {}) {
  return std::get<NoiseStudy>(measurement_noise(scans, region));
}

TEST(NoiseStudy, OfTwoScansIsTheirNoiseWhateverTheirTilt) {
  std::vector<HeightField> scans;
  scans.push_back(scan(1000, 500, 1, 0.2));
  scans.push_back(scan(1000, 500, 2, 0.2));
  add_plane(scans[1], 3.0, 0.02, -0.01);

  const NoiseStudy study = studied(pointers(scans));

  RecordProperty("statistical_16", std::to_string(std::abs(study.noise_um / 0.2 - 1.0)));
  EXPECT_NEAR(study.noise_um, 0.2, 0.002);
  EXPECT_EQ(study.scans, 2);
  EXPECT_EQ(study.points, 500'000);
  EXPECT_EQ(study.valid_fraction, 1.0);
}

TEST(NoiseStudy, OfTwoScansIsTheLevelledDifferenceOverRootTwo) {
  std::vector<HeightField> scans;
  scans.push_back(scan(31, 20, 3, 0.2));
  scans.push_back(scan(31, 20, 4, 0.5));
  add_plane(scans[0], -1.0, 0.1, 0.3);

  const NoiseStudy study = studied(pointers(scans));

  // On a full rectangle 1, x and y about their means are orthogonal, so a plane costs three products.
  double squares = 0.0;
  double sum = 0.0;
  double along_x = 0.0;
  double along_y = 0.0;
  double of_x = 0.0;
  double of_y = 0.0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 31; ++x) {
      const double d = scans[1].z_um.at(x, y) - scans[0].z_um.at(x, y);
      squares += d * d;
      sum += d;
      along_x += d * (x - 15.0);
      along_y += d * (y - 9.5);
      of_x += (x - 15.0) * (x - 15.0);
      of_y += (y - 9.5) * (y - 9.5);
    }
  }
  const double left = squares - sum * sum / 620.0 - along_x * along_x / of_x - along_y * along_y / of_y;
  EXPECT_NEAR(study.noise_um / std::sqrt(left / 620.0 / 2.0), 1.0, 1e-9);
}

TEST(NoiseStudy, PoolsManyScans) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 6; ++i) {
    scans.push_back(scan(200, 150, static_cast<std::uint64_t>(10 + i), 0.2));
    add_plane(scans.back(), 0.5 * i, 0.001 * i, -0.002 * i);
  }

  const NoiseStudy study = studied(pointers(scans));

  EXPECT_NEAR(study.noise_um, 0.2, 0.002);
  double squares = 0.0;
  for (const float here : study.noise_map_um.pixels()) squares += static_cast<double>(here) * static_cast<double>(here);
  EXPECT_NEAR(std::sqrt(squares / 30'000.0), study.noise_um, 1e-6);
}

TEST(NoiseStudy, OfTwoScansIsNearThatOfTwentyThroughAFocusWindow) {
  HeightField flat{Plane<double>(480, 360), Plane<float>(480, 360, 0.2F), 1.0, 1.0, {}};
  flat.kernel.weights.assign(9, 1.0 / 9.0);
  NoiseMaps noise(flat, 5);
  std::vector<HeightField> scans;
  for (std::uint64_t draw = 0; draw < 20; ++draw) {
    scans.push_back(flat.clone());
    noise.add_to_heights(draw, scans.back().z_um);
  }
  const std::vector<const HeightField*> all = pointers(scans);

  const double pooled = studied(all).noise_um;
  double worst = 0.0;
  for (std::size_t first = 0; first < 20; first += 2) {
    worst = std::max(worst, std::abs(studied(std::span(all).subspan(first, 2)).noise_um / pooled - 1.0));
  }

  RecordProperty("noise_error", std::to_string(worst));
  EXPECT_NEAR(pooled, 0.2, 0.004);
  EXPECT_LT(worst, 0.05);
}

TEST(NoiseStudy, DoesNotCountTheSurface) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 2; ++i) scans.push_back(scan(40, 30, 7, 0.2));
  for (HeightField& field : scans) {
    for (int x = 0; x < 40; ++x) field.z_um.at(x, x % 30) += 25.0;
  }

  EXPECT_NEAR(studied(pointers(scans)).noise_um, 0.0, 1e-12);
}

TEST(NoiseStudy, LeavesOutPointsThatOneScanHasNot) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 3; ++i) scans.push_back(scan(40, 30, static_cast<std::uint64_t>(20 + i), 0.2));
  scans[1].z_um.at(3, 4) = std::nan("");
  scans[2].z_um.at(5, 4) = std::nan("");
  scans[0].z_um.at(3, 4) = 1e6;

  const NoiseStudy study = studied(pointers(scans));

  EXPECT_EQ(study.points, 1198);
  EXPECT_NEAR(study.valid_fraction, 1198.0 / 1200.0, 1e-12);
  EXPECT_NEAR(study.noise_um, 0.2, 0.02);
  EXPECT_TRUE(std::isnan(study.noise_map_um.at(3, 4)));
  EXPECT_TRUE(std::isnan(study.noise_map_um.at(5, 4)));
  EXPECT_FALSE(std::isnan(study.noise_map_um.at(4, 4)));
}

TEST(NoiseStudy, LooksAtItsRegionOnly) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 2; ++i) scans.push_back(scan(40, 30, static_cast<std::uint64_t>(30 + i), 0.2));
  Region region(40, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) region.at(x, y) = x < 20 ? 1 : 0;
  }
  const NoiseStudy before = studied(pointers(scans), region);
  for (int y = 0; y < 30; ++y) scans[0].z_um.at(25, y) = 400.0;
  scans[0].z_um.at(7, 7) = std::nan("");
  scans[0].z_um.at(30, 7) = std::nan("");

  const NoiseStudy after = studied(pointers(scans), region);

  EXPECT_EQ(before.points, 600);
  EXPECT_EQ(after.points, 599);
  EXPECT_NEAR(after.valid_fraction, 599.0 / 600.0, 1e-12);
  EXPECT_NEAR(after.noise_um / before.noise_um, 1.0, 0.01);
}

TEST(NoiseStudy, IsComparedWithTheStatedSigma) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 4; ++i) scans.push_back(scan(100, 100, static_cast<std::uint64_t>(40 + i), 0.2));
  EXPECT_FALSE(studied(pointers(scans)).over_sigma);
  for (HeightField& field : scans) field.sigma_um = Plane<float>(100, 100, 0.4F);
  // Two scans state 0.1, two 0.7: the quadratic mean is 0.5.
  const NoiseStudy half = studied(pointers(scans));
  scans[0].sigma_um = Plane<float>(100, 100, 0.1F);
  scans[1].sigma_um = Plane<float>(100, 100, 0.1F);
  scans[2].sigma_um = Plane<float>(100, 100, 0.7F);
  scans[3].sigma_um = Plane<float>(100, 100, 0.7F);
  const NoiseStudy mixed = studied(pointers(scans));
  scans[3].sigma_um = {};

  ASSERT_TRUE(half.over_sigma && mixed.over_sigma);
  EXPECT_NEAR(*half.over_sigma, half.noise_um / 0.4, 1e-6);
  EXPECT_NEAR(*mixed.over_sigma, mixed.noise_um / 0.5, 1e-6);
  EXPECT_FALSE(studied(pointers(scans)).over_sigma);
}

TEST(NoiseStudy, IsRefusedOverTooFewPoints) {
  std::vector<HeightField> scans;
  for (int i = 0; i < 2; ++i) scans.push_back(scan(120, 2, static_cast<std::uint64_t>(i), 0.2));
  Region of_99(120, 2);
  for (int x = 0; x < 99; ++x) of_99.at(x, x % 2) = 1;
  Region of_100 = of_99.clone();
  of_100.at(100, 0) = 1;
  Region line(120, 2);
  for (int x = 0; x < 120; ++x) line.at(x, 0) = 1;

  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(measurement_noise(pointers(scans), of_99)));
  EXPECT_TRUE(std::holds_alternative<NoiseStudy>(measurement_noise(pointers(scans), of_100)));
  EXPECT_TRUE(std::holds_alternative<StudyRefusal>(measurement_noise(pointers(scans), line)));
}

TEST(NoiseStudy, TakesTwoToTwentyScansOfOneShapeAndPitch) {
  std::vector<HeightField> one;
  one.push_back(scan(20, 20, 1, 0.2));
  std::vector<HeightField> many;
  for (int i = 0; i < 21; ++i) many.push_back(scan(20, 20, 1, 0.2));
  const std::vector<const HeightField*> of_many = pointers(many);
  std::vector<HeightField> other_size;
  other_size.push_back(scan(20, 20, 1, 0.2));
  other_size.push_back(scan(20, 21, 1, 0.2));
  std::vector<HeightField> other_pitch;
  for (int i = 0; i < 2; ++i) other_pitch.push_back(scan(20, 20, 1, 0.2));
  other_pitch[1].pitch_y_um *= 1.001;

  EXPECT_THROW(static_cast<void>(measurement_noise({})), Error);
  EXPECT_THROW(static_cast<void>(measurement_noise(pointers(one))), Error);
  EXPECT_THROW(static_cast<void>(measurement_noise(of_many)), Error);
  EXPECT_NO_THROW(static_cast<void>(measurement_noise(std::span(of_many).first(20))));
  EXPECT_THROW(static_cast<void>(measurement_noise(pointers(other_size))), Error);
  EXPECT_THROW(static_cast<void>(measurement_noise(pointers(other_pitch))), Error);
  EXPECT_THROW(static_cast<void>(measurement_noise(std::span(of_many).first(2), Region(20, 19))), Error);
}

}  // namespace
}  // namespace fvd::metrology
