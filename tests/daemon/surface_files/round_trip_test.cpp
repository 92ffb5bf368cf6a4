#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/export/height_tiff.hpp"
#include "daemon/export/length_text.hpp"
#include "daemon/export/surface_writers.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "tests/daemon/surface_files/byte_text.hpp"
#include "tests/daemon/surface_files/peak_memory.hpp"
#include "tests/daemon/surface_files/sample_surface.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::ScratchDir;

SurfaceOrigin origin_of(const Surface& surface) {
  SurfaceOrigin origin;
  origin.title = surface.title;
  origin.part_id = "part-7";
  origin.source = "camera \xC3\xA9";
  origin.software_version = "1.2";
  return origin;
}

std::string bytes_in(const std::string& format, const Surface& surface) {
  return surface_bytes(*find_surface_writer(format), surface_view(surface, origin_of(surface)));
}

TEST(SurfaceFiles, TakeFewMebibytesBesideTheSurface) {
  if (test::kKeepsWhatIsFreed) GTEST_SKIP() << "a sanitizer keeps what is freed";
  const ScratchDir scratch;
  Surface surface;
  surface.height_m = Plane<float>(2400, 1800);
  surface.pitch_x_um = surface.pitch_y_um = 0.5;
  for (std::size_t i = 0; i < surface.height_m.pixels().size(); ++i) {
    surface.height_m.pixels()[i] = 1e-9F * static_cast<float>(i % 104729);
  }
  for (const std::string format : {"x3p", "gsf", "sdf", "csv"}) {
    SCOPED_TRACE(format);
    test::write_text(scratch / ("s." + format), bytes_in(format, surface));
    const test::PeakMemory memory;

    const Surface got = read_surface(scratch / ("s." + format));

    const auto bytes = static_cast<double>(got.height_m.pixels().size() * sizeof(float));
    const double beside_mib = memory.risen_mib() - bytes / 1048576.0;
    RecordProperty("reader_peak_mib", std::to_string(std::max(0.0, beside_mib)));
    EXPECT_LE(beside_mib, 64.0);
  }
}

TEST(SurfaceFiles, ReadBackWhatWasWrittenBitForBit) {
  const ScratchDir scratch;
  const Surface surface = test::sample_surface();
  for (const std::string format : {"x3p", "gsf", "sdf", "csv"}) {
    SCOPED_TRACE(format);
    test::write_text(scratch / ("s." + format), bytes_in(format, surface));

    const Surface got = read_surface(scratch / ("s." + format));

    test::expect_same_heights(got.height_m, surface.height_m);
    EXPECT_EQ(got.pitch_x_um, surface.pitch_x_um);
    EXPECT_EQ(got.pitch_y_um, surface.pitch_y_um);
    EXPECT_FALSE(got.has_sigma());
    EXPECT_EQ(got.title, format == "gsf" || format == "csv" ? surface.title : "s");
  }
}

TEST(SurfaceFiles, ReadBackHeightsOfEveryMagnitude) {
  const ScratchDir scratch;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> mantissa(-1.0F, 1.0F);
  std::uniform_int_distribution<int> exponent(-44, 12);
  Surface surface;
  surface.height_m = Plane<float>(500, 100);
  for (float& height : surface.height_m.pixels()) height = std::ldexp(mantissa(random), exponent(random));
  surface.height_m.at(0, 0) = -0.0F;
  surface.height_m.at(1, 0) = std::numeric_limits<float>::max();
  surface.height_m.at(2, 0) = std::numeric_limits<float>::denorm_min();
  surface.pitch_x_um = surface.pitch_y_um = 1.0;
  for (const std::string format : {"x3p", "gsf", "sdf", "csv"}) {
    SCOPED_TRACE(format);
    test::write_text(scratch / ("s." + format), bytes_in(format, surface));
    test::expect_same_heights(read_surface(scratch / ("s." + format)).height_m, surface.height_m);
  }
}

TEST(SurfaceFiles, GiveTheSameBytesForTheSameSurface) {
  const Surface surface = test::sample_surface();
  for (const SurfaceWriter& writer : surface_writers()) {
    const std::string format(writer.format);
    EXPECT_TRUE(bytes_in(format, surface) == bytes_in(format, surface.clone())) << format;
  }
}

TEST(SurfaceFiles, TakeThePitchOfATiffFromTheCaller) {
  const ScratchDir scratch;
  const Surface surface = test::sample_surface();
  test::write_text(scratch / "h.tiff", encode_height_tiff(surface.height_m, {"fvd", "heights", 0.48, 0.51}));

  const Surface got = read_surface(scratch / "h.tiff", {0.48, 0.51});

  test::expect_same_heights(got.height_m, surface.height_m);
  EXPECT_EQ(got.pitch_x_um, 0.48);
  EXPECT_EQ(got.pitch_y_um, 0.51);
}

TEST(SurfaceFiles, HoldTheStandardErrorsAsAFieldOfTheirOwn) {
  const ScratchDir scratch;
  const Surface surface = test::sample_surface();
  test::write_text(scratch / "sigma.gsf", bytes_in("gsf_sigma", surface));

  test::expect_same_heights(read_surface(scratch / "sigma.gsf").height_m, surface.sigma_m);
}

TEST(LengthText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(metres_text(1.0, 480), "0.00048");
  EXPECT_EQ(metres_text(0.1, 7), "7e-07");
  EXPECT_EQ(metres_text(0.48), "4.8e-07");
  EXPECT_EQ(micrometres_of_text("0.00048", 480), 1.0);
  EXPECT_EQ(micrometres_of_text("1e-6 m"), std::nullopt);
}

TEST(LengthText, KeepsEveryDigitOfAnyPitch) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  std::uniform_int_distribution<int> count(1, 5000);
  for (int i = 0; i < 2000; ++i) {
    const double pitch_um = std::pow(10.0, exponent(random));
    const int columns = count(random);
    EXPECT_EQ(micrometres_of_text(metres_text(pitch_um, columns), columns), pitch_um);
    char typed[32];
    std::snprintf(typed, sizeof typed, "%.15g", pitch_um);
    const double rounded_um = std::strtod(typed, nullptr);
    EXPECT_EQ(micrometres_of(metres_of(rounded_um)), rounded_um) << typed;
  }
}

TEST(SurfaceWriters, PutMainFirstIntoAnX3pAndStoreIt) {
  const std::string bytes = bytes_in("x3p", test::sample_surface());

  EXPECT_EQ(bytes.substr(0, 4), std::string("PK\3\4", 4));
  EXPECT_EQ(bytes.substr(30, 8), "main.xml");
  EXPECT_THAT(bytes, testing::HasSubstr("<FeatureType>SUR</FeatureType>"));
  EXPECT_THAT(bytes, testing::HasSubstr("<Increment>4.8e-07</Increment>"));
  EXPECT_THAT(bytes, testing::HasSubstr(R"("title":"part &lt;7&gt; &amp; \"co\"")"));
  EXPECT_THAT(bytes, testing::HasSubstr(R"("part_id":"part-7")"));
  EXPECT_THAT(bytes, testing::HasSubstr(R"("source":"camera \u00e9")"));
}

TEST(SurfaceWriters, MarkHolesInTheMaskOfAnX3pAsWell) {
  const std::string bytes = bytes_in("x3p", test::sample_surface());

  const auto directory = bytes.find(std::string("PK\1\2", 4));
  EXPECT_EQ(bytes.substr(directory - 5, 5), "\xFB\xFF\xFF\xFF\xFB") << "points 2 and 34 of 35; the rest is filled up";
}

TEST(SurfaceWriters, DateTheCalibrationOfAnX3pAsTheResult) {
  const Surface surface = test::sample_surface();
  SurfaceOrigin origin = origin_of(surface);
  origin.created = std::chrono::system_clock::time_point(std::chrono::milliseconds(1'700'000'000'123));

  const std::string xml = surface_bytes(*find_surface_writer("x3p"), surface_view(surface, origin));

  EXPECT_THAT(xml, testing::HasSubstr("<Date>2023-11-14T22:13:20.123Z</Date>"));
  EXPECT_THAT(xml, testing::HasSubstr("<CalibrationDate>2023-11-14T22:13:20.123Z</CalibrationDate>"));
}

TEST(SurfaceWriters, OrderTheElementsOfAnX3pAsItsSchemaDoes) {
  const std::string xml = bytes_in("x3p", test::sample_surface());
  std::size_t place = 0;
  for (const char* element : {"<Record1>",
                              "<Revision>",
                              "<FeatureType>",
                              "<Axes>",
                              "<CX>",
                              "<AxisType>",
                              "<DataType>",
                              "<Increment>",
                              "<Offset>",
                              "<CY>",
                              "<CZ>",
                              "</Axes>",
                              "<Record2>",
                              "<Date>",
                              "<Creator>",
                              "<Instrument>",
                              "<Manufacturer>",
                              "<Model>",
                              "<Serial>",
                              "<Version>",
                              "<CalibrationDate>",
                              "<ProbingSystem>",
                              "<Type>",
                              "<Identification>",
                              "<Comment>",
                              "<Record3>",
                              "<MatrixDimension>",
                              "<SizeX>",
                              "<SizeY>",
                              "<SizeZ>",
                              "<DataLink>",
                              "<PointDataLink>",
                              "<MD5ChecksumPointData>",
                              "<ValidPointsLink>",
                              "<MD5ChecksumValidPoints>",
                              "<Record4>",
                              "<ChecksumFile>"}) {
    const std::size_t found = xml.find(element, place);
    ASSERT_NE(found, std::string::npos) << element;
    place = found;
  }
}

TEST(SurfaceWriters, FillAnSdfAsTheStandardHasIt) {
  const std::string bytes = bytes_in("sdf", test::sample_surface());

  ASSERT_EQ(bytes.size(), 81U + 7U * 5U * 8U);
  EXPECT_EQ(bytes.substr(0, 18), "bISO-1.0fvd       ");
  EXPECT_EQ(bytes.substr(42, 4), test::little_all<std::uint16_t>(7, 5));
  EXPECT_EQ(bytes.substr(46, 32),
            test::little(0.48e-6) + test::little(0.51e-6) + test::little(1.0) + test::little(-1.0));
  EXPECT_EQ(bytes.substr(78, 3), std::string("\0\7\0", 3));
  EXPECT_EQ(bytes.substr(81, 8), test::little(static_cast<double>(0.0F)));
}

TEST(SurfaceWriters, RefuseWhatAFormatCannotHold) {
  SurfaceView view;
  const Plane<float> wide(65536, 1);
  view.height_m = wide.view();
  const ByteSink nowhere = [](std::string_view) {};
  EXPECT_THROW(write_surface(*find_surface_writer("x3p"), view, nowhere), Error) << "no pitch";
  view.pitch_x_um = view.pitch_y_um = 1.0;
  EXPECT_THROW(write_surface(*find_surface_writer("sdf"), view, nowhere), Error) << "too wide";
  EXPECT_THROW(write_surface(*find_surface_writer("gsf_sigma"), view, nowhere), Error) << "no sigma";
  EXPECT_EQ(find_surface_writer("obj"), nullptr);
}

/// 2 x 2 points with the lower right one a hole, 3 um apart in x and 5 um in y.
Surface corner() {
  Surface surface;
  surface.height_m = Plane<float>(2, 2, 1e-6F);
  surface.height_m.at(1, 0) = 2e-6F;
  surface.height_m.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
  surface.pitch_x_um = 3.0;
  surface.pitch_y_um = 5.0;
  return surface;
}

TEST(SurfaceWriters, MakeTrianglesInMillimetresWithTheirFrontToTheCamera) {
  const std::string bytes = bytes_in("stl", corner());

  ASSERT_EQ(bytes.size(), 84U + 50U);
  EXPECT_THAT(bytes.substr(0, 80), testing::HasSubstr("unit mm"));
  std::array<float, 12> values{};
  std::memcpy(values.data(), bytes.data() + 84, sizeof values);
  EXPECT_GT(values[2], 0.0F) << "normal";
  EXPECT_NEAR(values[0], -1.0 / std::sqrt(10.0), 1e-6) << "it rises by 1 um in 3 um";
  const std::array<float, 9> corners{0.0015F, 0.0075F, 0.001F, 0.0015F, 0.0025F, 0.001F, 0.0045F, 0.0075F, 0.002F};
  for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_NEAR(values[i + 3], corners[i], 1e-9) << i;
}

TEST(SurfaceWriters, GivePlyPointsTheirColourAndQuality) {
  Surface surface = corner();
  surface.sigma_m = Plane<float>(2, 2, 0.5e-6F);
  const Plane<std::uint16_t> grey(2, 2, 4095);
  SurfaceView view = surface_view(surface, {});
  view.grey = grey.view();
  view.max_grey = 4095;

  const std::string bytes = surface_bytes(*find_surface_writer("ply"), view);

  const std::size_t data = bytes.find("end_header\n") + 11;
  const std::string header = bytes.substr(0, data);
  EXPECT_THAT(header, testing::StartsWith("ply\nformat binary_little_endian 1.0\ncomment unit mm;"));
  EXPECT_THAT(header, testing::HasSubstr("element vertex 3\n"));
  EXPECT_THAT(header, testing::HasSubstr("uchar blue\nproperty float quality\nelement face 1\n"));
  ASSERT_EQ(bytes.size(), data + 3U * 19U + 13U);
  EXPECT_EQ(bytes.substr(data + 12, 3), "\xFF\xFF\xFF");
  EXPECT_EQ(bytes.substr(data + 15, 4), test::little(0.5e-6F * 1e3F));
  EXPECT_EQ(bytes.substr(data + 57), std::string("\3", 1) + test::little_all<std::int32_t>(0, 2, 1));
}

TEST(SurfaceWriters, WriteCsvForPeople) {
  Surface surface = corner();
  surface.height_m.at(0, 1) = -12.5e-6F;
  surface.title = "a\nb";

  EXPECT_EQ(bytes_in("csv", surface),
            "# fvd surface: heights, first row on top, first column left, nan = hole\n# title = a b\n# unit = um\n"
            "# pitch_x_um = 3\n# pitch_y_um = 5\n# columns = 2\n# rows = 2\n# PartId = part-7\n# Software = 1.2\n"
            "# Source = camera \xC3\xA9\n# Simulated = false\n1,2\n-12.5,nan\n");
}

}  // namespace
}  // namespace fvd
