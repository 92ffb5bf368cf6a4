#include "daemon/views/line_profile.hpp"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>

#include "daemon/evaluation/surface_chain.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/pipeline/stored_surface.hpp"
#include "tests/daemon/calibration/some_calibration.hpp"
#include "tests/daemon/views/made_maps.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using metrology::ProfileLine;
using test::ScratchDir;

/// 400 x 270 points with holes of one point and of many, and some standard errors that are none.
ResultData holey_result() {
  ResultData data = test::result_with(test::rough(400, 270, 0.02));
  for (int y = 100; y < 140; ++y) {
    for (int x = 130; x < 200; ++x) test::make_hole(data.map, x, y, mask_reason::kSaturated);
  }
  data.map.sigma_m.at(50, 60) = -1e-7F;
  data.map.sigma_m.at(51, 60) = test::kNoPoint;
  for (int x = 0; x < 400; ++x) data.map.sigma_m.at(x, 20) = 1e-8F * static_cast<float>(x + 1);
  data.pixel_pitch_x_um = 0.1 + 0.2;
  data.pixel_pitch_y_um = 1.0 / 3.0;
  return data;
}

/// As an evaluation has it.
metrology::HeightField evaluated_field(const std::filesystem::path& folder) {
  const StoredSurface stored = read_stored_surface(folder);
  const EvaluationPlan plan;
  return SurfaceChain(stored.surface, plan, stored.context, nullptr).state(kMeasuredSurface).field.clone();
}

bool is_same(double a, double b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }

void expect_evaluated_profile(const metrology::HeightField& field, const LineProfile& got, const ProfileLine& line) {
  const metrology::Profile wanted = metrology::extract_profile(field, line);
  ASSERT_EQ(got.height_um.size(), wanted.z_um.size());
  ASSERT_EQ(got.distance_um.size(), wanted.z_um.size());
  ASSERT_EQ(got.sigma_um.size(), wanted.z_um.size());
  for (std::size_t i = 0; i < wanted.z_um.size(); ++i) {
    EXPECT_TRUE(is_same(got.height_um[i], wanted.z_um[i])) << "point " << i << ": " << got.height_um[i];
    EXPECT_DOUBLE_EQ(got.distance_um[i], (static_cast<double>(i) + 0.5) * wanted.pitch_um);
    EXPECT_EQ(std::isnan(got.sigma_um[i]), std::isnan(wanted.z_um[i]));
  }
}

/// 30 lines in all directions, narrow and wide, that stay in the field.
std::vector<ProfileLine> some_lines(double width_um, double height_um) {
  std::vector<ProfileLine> lines;
  test::Noise noise;
  while (lines.size() < 30) {
    ProfileLine line{.from_x_um = noise.next() * width_um,
                     .from_y_um = noise.next() * height_um,
                     .to_x_um = noise.next() * width_um,
                     .to_y_um = noise.next() * height_um,
                     .band_width_um = lines.size() % 3 == 0 ? 0.0 : noise.next() * 8.0};
    const double margin = line.band_width_um;
    const auto fits = [margin](double place, double end) { return place > margin && place < end - margin; };
    if (std::hypot(line.to_x_um - line.from_x_um, line.to_y_um - line.from_y_um) < 5.0) continue;
    if (!fits(line.from_x_um, width_um) || !fits(line.to_x_um, width_um)) continue;
    if (!fits(line.from_y_um, height_um) || !fits(line.to_y_um, height_um)) continue;
    lines.push_back(line);
  }
  lines.push_back({.from_x_um = 0.0, .from_y_um = 0.0, .to_x_um = width_um, .to_y_um = height_um});
  lines.push_back({.from_x_um = width_um,
                   .from_y_um = height_um / 2,
                   .to_x_um = 0.0,
                   .to_y_um = height_um / 2,
                   .band_width_um = height_um});
  return lines;
}

TEST(LineProfile, IsTheEvaluationsBitForBit) {
  for (const bool calibrated : {false, true}) {
    const ScratchDir scratch;
    ResultData data = holey_result();
    if (calibrated) data.calibration = test::whole_calibration();
    const StoredJob job = test::stored_result(scratch / "J7", data);
    const metrology::HeightField field = evaluated_field(scratch / "J7");
    const Result result = read_result_json(job.result_json);
    ResultMaps maps(scratch / "J7");
    std::size_t holes = 0;
    std::size_t heights = 0;
    for (const ProfileLine& line : some_lines(400 * field.pitch_x_um, 270 * field.pitch_y_um)) {
      const LineProfile got = line_profile(maps, result, line);
      expect_evaluated_profile(field, got, line);
      for (const double z_um : got.height_um) ++(std::isnan(z_um) ? holes : heights);
    }
    EXPECT_GT(holes, 100U);
    EXPECT_GT(heights, 1000U);
  }
}

TEST(LineProfile, HasTheMeanStandardErrorOfTheBand) {
  const ScratchDir scratch;
  ResultData data = test::result_with(Plane<float>(40, 30, 1e-6F));
  for (int x = 0; x < 40; ++x) {
    data.map.sigma_m.at(x, 9) = 0.1e-6F;
    data.map.sigma_m.at(x, 10) = 0.3e-6F;
  }
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = 1.0;
  const StoredJob job = test::stored_result(scratch / "J7", data);
  ResultMaps maps(scratch / "J7");

  const LineProfile got =
      line_profile(maps, read_result_json(job.result_json),
                   {.from_x_um = 5.0, .from_y_um = 10.0, .to_x_um = 35.0, .to_y_um = 10.0, .band_width_um = 2.0});

  ASSERT_EQ(got.sigma_um.size(), 30U);
  for (const double sigma_um : got.sigma_um) EXPECT_NEAR(sigma_um, 0.2, 1e-6);
}

TEST(LineProfile, WithoutStandardErrorsHasHeightsAlone) {
  const ScratchDir scratch;
  ResultData data = holey_result();
  data.exports = {"gsf"};
  write_result(scratch / "J7", data);
  std::filesystem::remove(scratch / "J7" / "sigma.gsf");
  ResultMaps maps(scratch / "J7");
  const Result result = read_result_json(test::read_text(scratch / "J7" / "result.json"));
  const ProfileLine line{.from_x_um = 5.0, .from_y_um = 20.0, .to_x_um = 110.0, .to_y_um = 20.0};

  const LineProfile got = line_profile(maps, result, line);

  const metrology::Profile wanted = metrology::extract_profile(evaluated_field(scratch / "J7"), line);
  ASSERT_EQ(got.height_um.size(), wanted.z_um.size());
  for (std::size_t i = 0; i < wanted.z_um.size(); ++i) {
    EXPECT_TRUE(is_same(got.height_um[i], wanted.z_um[i]));
    EXPECT_TRUE(std::isnan(got.sigma_um[i]));
  }
}

TEST(LineProfile, GoesThroughTheLetterFTheRightWayRound) {
  const ScratchDir scratch;
  ResultData data = test::result_with(test::letter_f(64, 64));
  data.pixel_pitch_x_um = data.pixel_pitch_y_um = 1.0;
  const StoredJob job = test::stored_result(scratch / "J7", data);
  ResultMaps maps(scratch / "J7");
  const auto inked = [&](const ProfileLine& line) {
    const LineProfile got = line_profile(maps, read_result_json(job.result_json), line);
    return std::count_if(got.height_um.begin(), got.height_um.end(), [](double z_um) { return z_um > 5.0; });
  };

  const auto upper = inked({.from_x_um = 0.5, .from_y_um = 12.0, .to_x_um = 63.5, .to_y_um = 12.0});
  const auto lower = inked({.from_x_um = 0.5, .from_y_um = 52.0, .to_x_um = 63.5, .to_y_um = 52.0});
  const auto left = inked({.from_x_um = 12.0, .from_y_um = 0.5, .to_x_um = 12.0, .to_y_um = 63.5});
  const auto right = inked({.from_x_um = 50.0, .from_y_um = 0.5, .to_x_um = 50.0, .to_y_um = 63.5});

  EXPECT_NEAR(static_cast<double>(upper), 48.0, 1.0);
  EXPECT_NEAR(static_cast<double>(lower), 8.0, 1.0);
  EXPECT_NEAR(static_cast<double>(left), 48.0, 1.0);
  EXPECT_NEAR(static_cast<double>(right), 8.0, 1.0);
}

TEST(LineProfile, IsRefusedWhereThereIsNone) {
  const ScratchDir scratch;
  const StoredJob job = test::stored_result(scratch / "J7", test::result_with(test::rough(16, 16, 0.0)));
  Result result = read_result_json(job.result_json);
  ResultMaps maps(scratch / "J7");
  const ProfileLine good{.from_x_um = 4.0, .from_y_um = 8.0, .to_x_um = 20.0, .to_y_um = 8.0};  // pitch 2 and 4 um
  EXPECT_NO_THROW((void)line_profile(maps, result, good));
  const auto with = [&good](auto change) {
    ProfileLine line = good;
    change(line);
    return line;
  };

  FVD_EXPECT_ERROR(kRegionOutside, (void)line_profile(maps, result, with([](auto& line) { line.to_x_um = 33.0; })));
  FVD_EXPECT_ERROR(kRegionOutside, (void)line_profile(maps, result, with([](auto& line) { line.from_y_um = -1.0; })));
  FVD_EXPECT_ERROR(kRegionOutside,
                   (void)line_profile(maps, result, with([](auto& line) { line.band_width_um = 20.0; })));
  FVD_EXPECT_ERROR(kBadInput, (void)line_profile(maps, result, with([](auto& line) { line.to_x_um = 4.5; })));
  FVD_EXPECT_ERROR(kBadInput, (void)line_profile(maps, result, with([](auto& line) { line.band_width_um = -1.0; })));
  FVD_EXPECT_ERROR(kBadInput, (void)line_profile(maps, result, with([](auto& line) { line.to_x_um = std::nan(""); })));
  result.focus.pixel_pitch_x_um.reset();
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)line_profile(maps, result, good), testing::HasSubstr("pixel_pitch_x_um"));
  result = read_result_json(job.result_json);
  result.focus.width_px = 17;
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)line_profile(maps, result, good), testing::HasSubstr("17 x 16"));
  ResultMaps none(scratch / "none");
  FVD_EXPECT_ERROR_SAYING(kSurfaceFile, (void)line_profile(none, result, good),
                          testing::HasSubstr("no file of heights"));
}

}  // namespace
}  // namespace fvd
