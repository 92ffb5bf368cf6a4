#include <chrono>
#include <cmath>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <tiffio.h>
#include <tiffio.hxx>

#include "daemon/export/height_tiff.hpp"
#include "daemon/export/mask_png.hpp"
#include "daemon/export/texture_png.hpp"
#include "daemon/report/axis_ticks.hpp"
#include "daemon/report/surface_pictures.hpp"
#include "tests/daemon/export/sample_result.hpp"

namespace fvd {
namespace {

cv::Mat decode(const std::string& bytes) {
  const std::vector<unsigned char> data(bytes.begin(), bytes.end());
  return cv::imdecode(data, cv::IMREAD_UNCHANGED);
}

TEST(HeightTiff, ReadsBackExactlyWithItsHoles) {
  HeightMap map = test::sample_map(300, 200);
  test::make_hole(map, 3, 2, mask_reason::kLowProminence);
  const cv::Mat image = decode(encode_height_tiff(map.height_m, {"fvd", "d", 2.0, 2.0}));
  ASSERT_EQ(image.type(), CV_32FC1);
  ASSERT_EQ(image.size(), cv::Size(300, 200));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      if (x == 3 && y == 2) {
        EXPECT_TRUE(std::isnan(image.at<float>(y, x)));
      } else {
        ASSERT_EQ(image.at<float>(y, x), map.height_m.at(x, y)) << x << "," << y;
      }
    }
  }
}

TEST(HeightTiff, SaysWhatItHolds) {
  std::istringstream bytes(encode_height_tiff(test::sample_map().height_m, {"fvd 1.2.3", "metres", 2.0, 4.0}));
  TIFF* tiff = TIFFStreamOpen("test", &bytes);
  ASSERT_NE(tiff, nullptr);
  const char* text = nullptr;
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_SOFTWARE, &text), 1);
  EXPECT_STREQ(text, "fvd 1.2.3");
  EXPECT_EQ(TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text), 1);
  EXPECT_STREQ(text, "metres");
  std::uint16_t value = 0;
  TIFFGetField(tiff, TIFFTAG_SAMPLEFORMAT, &value);
  EXPECT_EQ(value, SAMPLEFORMAT_IEEEFP);
  TIFFGetField(tiff, TIFFTAG_COMPRESSION, &value);
  EXPECT_EQ(value, COMPRESSION_NONE);
  TIFFGetField(tiff, TIFFTAG_RESOLUTIONUNIT, &value);
  EXPECT_EQ(value, RESUNIT_CENTIMETER);
  float resolution = 0;
  TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution);
  EXPECT_FLOAT_EQ(resolution, 5000.0F);
  TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &resolution);
  EXPECT_FLOAT_EQ(resolution, 2500.0F);
  TIFFClose(tiff);
}

TEST(MaskPng, HasNoBitWhereValidAndTheReasonsElsewhere) {
  HeightMap map = test::sample_map();
  constexpr unsigned kLastBit = 1U << 13U;
  test::make_hole(map, 5, 0, kLastBit | mask_reason::kSaturated);
  test::make_hole(map, 1, 2, mask_reason::kLastSlice | mask_reason::kLowProminence);
  const cv::Mat image = decode(encode_mask_png(map));
  ASSERT_EQ(image.type(), CV_16UC1);
  EXPECT_EQ(image.at<std::uint16_t>(0, 0), 0);
  EXPECT_EQ(image.at<std::uint16_t>(2, 1), mask_reason::kLastSlice | mask_reason::kLowProminence);
  EXPECT_EQ(image.at<std::uint16_t>(0, 5), kLastBit | mask_reason::kSaturated);
}

TEST(TexturePng, KeepsTheGreyLevelsOfTheCamera) {
  HeightMap map = test::sample_map();
  const cv::Mat narrow = decode(encode_texture_png(map));
  ASSERT_EQ(narrow.type(), CV_8UC1);
  EXPECT_EQ(narrow.at<std::uint8_t>(2, 5), 25);

  map.texture_format = PixelFormat::kMono12;
  map.texture.at(0, 0) = 4095;
  const cv::Mat wide = decode(encode_texture_png(map));
  ASSERT_EQ(wide.type(), CV_16UC1);
  EXPECT_EQ(wide.at<std::uint16_t>(0, 0), 4095) << "not stretched";
}

Result preview_result() {
  Result result;
  result.job = {"J7", 4711, "part-42"};
  result.recipe.id = "chapter";
  result.provenance.created = std::chrono::system_clock::time_point(std::chrono::seconds(1'700'000'000));
  result.measurements = {{"height_mean", "height", 12.5, "um", {}, {}, {}, 100, 1.0, {}, {}}};
  return result;
}

std::string preview_bytes(const HeightMap& map, const Result& result) {
  PictureSurface surface;
  surface.height_m = map.height_m.view();
  surface.pitch_x_um = surface.pitch_y_um = 2.0;
  surface.title = "title";
  surface.simulated = true;
  return overview_png(surface, result);
}

cv::Mat preview_of(const HeightMap& map) { return decode(preview_bytes(map, preview_result())); }

TEST(Preview, PaintsHolesInNeutralGreyAndHeightsInColour) {
  HeightMap map = test::sample_map(400, 300);
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 300; ++y) test::make_hole(map, x, y, mask_reason::kLowProminence);
  }
  const cv::Mat page = preview_of(map);

  // The field begins at (92, 126) and has 2.6 pixels a point.
  const auto at = [&page](double x, double y) {
    return page.at<cv::Vec3b>(static_cast<int>(126 + 2.6 * y), static_cast<int>(92 + 2.6 * x));
  };
  EXPECT_EQ(at(100, 150), cv::Vec3b(170, 170, 170));
  const auto surface = at(300, 150);
  EXPECT_TRUE(surface[0] != surface[1] || surface[1] != surface[2]);
  EXPECT_NE(at(300, 2), at(300, 297)) << "heights differ";
  EXPECT_EQ(at(-2, 2), cv::Vec3b(255, 255, 255)) << "the paper beside the field";
}

TEST(Preview, FitsMapsOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 700}, {5000, 40}, {3000, 2000}, {60, 45}}) {
    const cv::Mat page = preview_of(test::sample_map(width, height));
    EXPECT_GE(page.cols, 1000) << width;
    EXPECT_LE(page.cols, 1300) << width;
    EXPECT_GE(page.rows, 300) << width;
    EXPECT_LE(page.rows, 1400) << width;
  }
}

TEST(Preview, DrawsAMapWithoutAnyValidPointAndAFlatOne) {
  HeightMap holes = test::sample_map(30, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) test::make_hole(holes, x, y, mask_reason::kLowProminence);
  }
  EXPECT_FALSE(preview_of(holes).empty());
  HeightMap flat = test::sample_map(30, 20);
  for (float& z : flat.height_m.pixels()) z = 1e-4F;
  EXPECT_FALSE(preview_of(flat).empty());
}

TEST(Preview, TellsJobDateVerdictAndValues) {
  const HeightMap map = test::sample_map(40, 30);
  const Result result = preview_result();
  const std::string plain = preview_bytes(map, result);
  EXPECT_TRUE(plain == preview_bytes(map, result)) << "the same bytes";
  const auto expect_told = [&](const char* what, const std::function<void(Result&)>& change) {
    Result other = result;
    change(other);
    EXPECT_FALSE(plain == preview_bytes(map, other)) << what;
  };
  expect_told("job", [](Result& other) { other.job.id = "J8"; });
  expect_told("date", [](Result& other) { other.provenance.created += std::chrono::seconds(1); });
  expect_told("recipe", [](Result& other) { other.recipe.id = "groove"; });
  expect_told("verdict", [](Result& other) { other.verdict = Verdict::kFail; });
  expect_told("map's values", [](Result& other) { other.measurements.front().value = 12.6; });
  expect_told("an evaluation's main value", [](Result& other) { other.evaluation = test::sample_measurements(); });
}

TEST(Preview, GrowsWithItsValuesToADozenOfThem) {
  const HeightMap map = test::sample_map(40, 30);
  const auto rows = [&map](int measurements) {
    Result result = preview_result();
    result.evaluation.emplace();
    for (int i = 0; i < measurements; ++i) {
      const std::string name = "m" + std::to_string(10 + i);
      result.evaluation->order.push_back(name);
      EvaluatedMeasurement& made = result.evaluation->measurements[name];
      made.main_value = "a_um";
      for (const char* key : {"a_um", "b_um"}) made.values[key].value = 1.0;  // b is no main value and has no limits
    }
    return decode(preview_bytes(map, result)).rows;
  };

  EXPECT_NEAR(rows(2) - rows(1), 23, 1) << "one row of 11.5 points";
  EXPECT_GT(rows(13), rows(12)) << "that there are more";
  EXPECT_EQ(rows(40), rows(13));
}

TEST(AxisTicks, AreRoundAndInsideTheRange) {
  const AxisTicks ticks = axis_ticks(-7.3, 162.0, 8);
  ASSERT_EQ(ticks.values, (std::vector<double>{0, 20, 40, 60, 80, 100, 120, 140, 160}));
  EXPECT_EQ(ticks.decimals, 0);
  EXPECT_EQ(fixed_text(ticks.values.back(), ticks.decimals), "160");
}

TEST(AxisTicks, HaveTheDecimalsThatTellThemApart) {
  const AxisTicks ticks = axis_ticks(1.0, 1.1, 6);
  ASSERT_EQ(ticks.values.size(), 6U);
  EXPECT_EQ(ticks.decimals, 2);
  EXPECT_EQ(fixed_text(ticks.values[1], ticks.decimals), "1.02");
  EXPECT_EQ(fixed_text(-0.001, 2), "0.00");
}

}  // namespace
}  // namespace fvd
