#include "daemon/export/gsf.hpp"

#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "tests/daemon/export/sample_result.hpp"

namespace fvd {
namespace {

TEST(Gsf, IsExactlyHeaderPaddingAndPixels) {
  Plane<float> height_m(2, 1);
  height_m.at(0, 0) = 1.0F;           // 00 00 80 3f
  height_m.at(1, 0) = std::nanf("");  // 00 00 c0 7f

  const std::string file = encode_gsf(height_m, {"plate", 2.0, 4.0, {{"PartId", "42"}}});

  const std::string header =
      "Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\nXReal = 4e-06\nYReal = 4e-06\nXYUnits = m\nZUnits = m\n"
      "Title = plate\nPartId = 42\n";
  ASSERT_EQ(header.size() % 4, 1U) << "three NULs expected below";
  const std::string pixels("\x00\x00\x80\x3f\x00\x00\xc0\x7f", 8);
  EXPECT_EQ(file, header + std::string(3, '\0') + pixels);
}

TEST(Gsf, PadsWithOneToFourZerosToAMultipleOfFour) {
  const Plane<float> height_m(1, 1, 0.5F);
  for (int length = 0; length < 8; ++length) {
    const std::string file = encode_gsf(height_m, {std::string(static_cast<std::size_t>(length), 'x'), {}, {}, {}});
    const auto text = file.find('\0');
    const auto padding = file.size() - sizeof(float) - text;
    EXPECT_EQ((text + padding) % 4, 0U) << length;
    EXPECT_GE(padding, 1U) << length;
    EXPECT_LE(padding, 4U) << length;
    float value = 0;
    std::memcpy(&value, file.data() + file.size() - sizeof value, sizeof value);
    EXPECT_EQ(value, 0.5F);
  }
}

TEST(Gsf, GivesThePixelAsUnitWhereThePitchIsUnknown) {
  const std::string file = encode_gsf(Plane<float>(7, 5), {"t", {}, {}, {}});
  EXPECT_NE(file.find("XReal = 7\nYReal = 5\nXYUnits = px\n"), std::string::npos);
}

TEST(Gsf, KeepsATextOnItsLine) {
  const std::string file = encode_gsf(Plane<float>(1, 1), {"a\nXRes = 9", {}, {}, {}});
  EXPECT_NE(file.find("Title = a XRes = 9\n"), std::string::npos);
}

}  // namespace
}  // namespace fvd
