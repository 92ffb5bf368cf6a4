#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "daemon/surface_files/surface_files.hpp"
#include "tests/daemon/surface_files/byte_text.hpp"
#include "tests/daemon/surface_files/sample_surface.hpp"
#include "tests/daemon/surface_files/zip_builder.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using test::little_all;
using test::ScratchDir;

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

/// 3 x 2 heights, given in um.
Plane<float> heights(std::initializer_list<double> um) {
  Plane<float> plane(3, 2);
  std::size_t i = 0;
  for (const double height : um) plane.pixels()[i++] = static_cast<float>(height * 1e-6);
  return plane;
}

void expect_surface(const Surface& surface, std::initializer_list<double> um) {
  ASSERT_EQ(surface.width(), 3);
  ASSERT_EQ(surface.height(), 2);
  const Plane<float> expected = heights(um);
  for (std::size_t i = 0; i < 6; ++i) {
    const float got = surface.height_m.pixels()[i];
    const float wanted = expected.pixels()[i];
    EXPECT_EQ(std::isnan(got), std::isnan(wanted)) << i;
    if (!std::isnan(wanted)) {
      EXPECT_NEAR(got, wanted, 1e-12) << i;
    }
  }
  EXPECT_EQ(surface.pitch_x_um, 0.5);
  EXPECT_EQ(surface.pitch_y_um, 0.25);
}

class AForeignFile : public testing::Test {
 protected:
  Surface read(const std::string& name, const std::string& bytes, const SurfaceReadOptions& options = {}) {
    test::write_text(scratch_ / name, bytes);
    return read_surface(scratch_ / name, options);
  }
  Surface read_x3p(const test::X3pText& text, const std::string& points, const std::string* valid = nullptr,
                   bool deflate = true) {
    test::build_zip(scratch_ / "a.x3p", text.entries(points, valid), deflate);
    return read_surface(scratch_ / "a.x3p");
  }

  ScratchDir scratch_;
};

TEST_F(AForeignFile, MayBeAnX3pOfIntegersWithMaskAndIncrement) {
  test::X3pText text;
  text.axis_z = "<AxisType>A</AxisType><DataType>I</DataType><Increment>1e-8</Increment><Offset>-2e-6</Offset>";
  const std::string valid("\x2F", 1);  // bits 0 to 3 and 5: point 4 is a hole
  expect_surface(read_x3p(text, little_all<std::int16_t>(0, 100, 200, -100, 7, 32767), &valid),
                 {-2.0, -1.0, 0.0, -3.0, static_cast<double>(kHole), 325.67});

  text.axis_z = "<AxisType>A</AxisType><DataType>L</DataType><Increment>1e-9</Increment>";
  expect_surface(read_x3p(text, little_all<std::int32_t>(0, 1000, -2000, 3000000, 4, 5)),
                 {0.0, 1.0, -2.0, 3000.0, 0.004, 0.005});
}

TEST_F(AForeignFile, MayBeAnX3pOfFloatsWithHoles) {
  test::X3pText text;
  text.axis_z = "<AxisType>A</AxisType><DataType>F</DataType>";
  const float infinite = std::numeric_limits<float>::infinity();
  expect_surface(read_x3p(text, little_all<float>(1e-6F, kHole, infinite, -infinite, 2e-6F, 0.0F), nullptr, false),
                 {1.0, static_cast<double>(kHole), static_cast<double>(kHole), static_cast<double>(kHole), 2.0, 0.0});

  text.axis_z = "<AxisType>A</AxisType><DataType>D</DataType><Increment>1</Increment><Offset>0</Offset>";
  text.rotation =
      "<Rotation><r11>1</r11><r12>0</r12><r13>0</r13><r21>0</r21><r22>1</r22><r23>0</r23><r31>0</r31><r32>0</r32>"
      "<r33>1.0</r33></Rotation>";
  text.prologue += "<!-- a comment -->";
  expect_surface(read_x3p(text, little_all<double>(1e-6, 1e300, 0.0, 3e-6, 4e-6, 5e-6)),
                 {1.0, static_cast<double>(kHole), 0.0, 3.0, 4.0, 5.0});
}

TEST_F(AForeignFile, MayBeAnSdfOfEveryTypeInEitherByteOrder) {
  const auto check = [this](std::uint8_t type, auto zero, auto least) {
    using T = decltype(zero);
    constexpr bool kSigned = std::is_signed_v<T>;
    for (const bool big_endian : {false, true}) {
      SCOPED_TRACE(std::to_string(type) + (big_endian ? " big" : " little"));
      test::SdfText text;
      text.type = type;
      text.z_scale = 1e-7;
      std::string bytes = text.bytes(big_endian);
      for (const int value : {10, 20, 30, 100, 5}) bytes += test::number_bytes(static_cast<T>(value), big_endian);
      bytes += test::number_bytes(least, big_endian);
      expect_surface(read("a.sdf", bytes), {1.0, 2.0, 3.0, 10.0, 0.5, kSigned ? static_cast<double>(kHole) : 0.0});
    }
  };
  check(0, std::uint8_t{0}, std::uint8_t{0});
  check(1, std::uint16_t{0}, std::uint16_t{0});
  check(2, std::uint32_t{0}, std::uint32_t{0});
  check(3, 0.0F, std::numeric_limits<float>::lowest());
  check(4, std::int8_t{0}, std::numeric_limits<std::int8_t>::min());
  check(5, std::int16_t{0}, std::numeric_limits<std::int16_t>::min());
  check(6, std::int32_t{0}, std::numeric_limits<std::int32_t>::min());
  check(7, 0.0, std::numeric_limits<double>::lowest());
  check(7, 0.0, std::numeric_limits<double>::quiet_NaN());
}

TEST_F(AForeignFile, MayBeAnSdfWithATrailerOrOfTheOldVersion) {
  test::SdfText text;
  text.magic = "bBCR-1.0";
  const std::string points = little_all<std::int16_t>(0, 1000, 2000, -3000, 4000, 5000);
  expect_surface(read("a.sdf", text.bytes() + points + "\r\n*\r\nOperator = x\r\n*\r\n"),
                 {0.0, 1.0, 2.0, -3.0, 4.0, 5.0});
}

TEST_F(AForeignFile, MayBeAnSdfInAscii) {
  const std::string head =
      "aISO-1.0\r\nManufacID   = maker\r\nCreateDate  = 291120261200 ; today\r\nNumPoints   = 3\r\nNumProfiles = 2\r\n"
      "Xscale      = 5.0E-7\r\nYscale      = 2.5e-7\r\nZscale      = 1e-9\r\nZresolution = -1\r\nCompression = 0\r\n"
      "DataType    = 6\r\nCheckType   = 0\r\n*\r\n";
  expect_surface(
      read("a.sdf", head + "1000 -2000 BAD ; a remark 7 8\r\n 3000\r\n-2147483648 +4000\r\n*\r\nend = 1\r\n*\r\n"),
      {1.0, -2.0, static_cast<double>(kHole), 3.0, static_cast<double>(kHole), 4.0});
  expect_surface(read("b.sdf", head + "1000 NaN inf 1e3 2.5e2 0"),
                 {1.0, static_cast<double>(kHole), static_cast<double>(kHole), 1.0, 0.25, 0.0});
}

TEST_F(AForeignFile, MayBeAGsf) {
  std::string head =
      "Gwyddion Simple Field 1.0\nXRes = 3\nYRes=2\nXReal = 1.5e-6\nYReal = 5e-07\nXYUnits = m\nZUnits = m\nOther = "
      "x\n";
  head.append(4 - head.size() % 4, '\0');
  const std::string points =
      little_all<float>(0.0F, 1e-6F, kHole, 3e-6F, std::numeric_limits<float>::infinity(), 5e-6F);
  expect_surface(read("a.gsf", head + points),
                 {0.0, 1.0, static_cast<double>(kHole), 3.0, static_cast<double>(kHole), 5.0});
}

TEST_F(AForeignFile, NeedsThePitchWhereItTellsNone) {
  std::string head = "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\nXReal = 3\nYReal = 2\nXYUnits = px\nZUnits = m\n";
  head.append(4 - head.size() % 4, '\0');
  const std::string points = little_all<float>(0.0F, 1e-6F, 2e-6F, 3e-6F, 4e-6F, 5e-6F);
  EXPECT_THROW((void)read("a.gsf", head + points), Error);
  expect_surface(read("a.gsf", head + points, {0.5, 0.25}), {0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
}

TEST_F(AForeignFile, MayBeACsvOfAnySeparatorAndUnit) {
  const SurfaceReadOptions pitch{0.5, 0.25};
  expect_surface(read("a.csv", "# unit = nm\n1000,-2000,\n3e3,+4000,nan\n", pitch),
                 {1.0, -2.0, static_cast<double>(kHole), 3.0, 4.0, static_cast<double>(kHole)});
  expect_surface(
      read("a.txt", "\n#unit=mm\n# pitch_x_um = 0.5\r\n#pitch_y_um=0.25\r\n 0.001  0.002   0.003 \n.004 5e-3 0\n"),
      {1.0, 2.0, 3.0, 4.0, 5.0, 0.0});
  expect_surface(read("a.asc", "# unit = m\n1e-6;2e-6;3e-6\n4e-6;inf;0\n", pitch),
                 {1.0, 2.0, 3.0, 4.0, static_cast<double>(kHole), 0.0});
}

}  // namespace
}  // namespace fvd
