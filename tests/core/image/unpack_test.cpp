#include "core/image/unpack.hpp"

#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> result;
  for (const int value : values) result.push_back(static_cast<std::byte>(value));
  return result;
}

std::vector<unsigned> pixels_of(const std::vector<std::byte>& slice, bool wide) {
  std::vector<unsigned> result;
  for (std::size_t i = 0; i < slice.size(); i += wide ? 2 : 1) {
    std::uint16_t value = static_cast<std::uint8_t>(slice[i]);
    if (wide) std::memcpy(&value, &slice[i], 2);
    result.push_back(value);
  }
  return result;
}

std::vector<unsigned> unpacked(SensorFormat format, const std::vector<std::byte>& wire, int width, int height,
                               int significant_bits = 0, BayerUse bayer = BayerUse::kGreen) {
  const bool wide = bytes_per_pixel(slice_format(format, significant_bits)) == 2;
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<std::byte> slice(count * (wide ? 2 : 1));
  unpack({format, significant_bits, bayer, width, height, wire}, slice);
  return pixels_of(slice, wide);
}

TEST(Unpack, KnowsTheLayoutsByHand) {
  // 0x123, 0xABC
  EXPECT_EQ(unpacked(SensorFormat::kMono12p, bytes({0x23, 0xC1, 0xAB}), 2, 1), (std::vector<unsigned>{0x123, 0xABC}));
  EXPECT_EQ(unpacked(SensorFormat::kMono12Packed, bytes({0x12, 0xC3, 0xAB}), 2, 1),
            (std::vector<unsigned>{0x123, 0xABC}));
  // 0x3FF, 0, 0x155, 0x2AA: 10 bits each, least significant first
  EXPECT_EQ(unpacked(SensorFormat::kMono10p, bytes({0xFF, 0x03, 0x50, 0x95, 0xAA}), 4, 1),
            (std::vector<unsigned>{0x3FF, 0x000, 0x155, 0x2AA}));
  EXPECT_EQ(unpacked(SensorFormat::kMono16, bytes({0x30, 0x12}), 1, 1, 12), (std::vector<unsigned>{0x123}));
  EXPECT_EQ(unpacked(SensorFormat::kMono8, bytes({7, 8}), 2, 1), (std::vector<unsigned>{7, 8}));
}

TEST(Unpack, MakesOneValueAPixelOfAMosaic) {
  // G R G      10 99 20
  // B G B      99 30 99
  // G R G      40 99 50
  const auto mosaic = bytes({10, 99, 20, 99, 30, 99, 40, 99, 50});
  EXPECT_EQ(unpacked(SensorFormat::kBayerGR8, mosaic, 3, 3),
            (std::vector<unsigned>{10, (10 + 20 + 30 + 30 + 2) / 4, 20, (30 + 30 + 10 + 40 + 2) / 4, 30,
                                   (30 + 30 + 20 + 50 + 2) / 4, 40, (40 + 50 + 30 + 30 + 2) / 4, 50}));
  const auto two = bytes({1, 2, 3, 5});
  EXPECT_EQ(unpacked(SensorFormat::kBayerRG8, two, 2, 2, 0, BayerUse::kLuminance), (std::vector<unsigned>{3, 3, 3, 3}));
}

TEST(Unpack, EqualsTheReferenceBitForBit) {
  std::mt19937 random(1);
  for (const SensorFormat format : kAllSensorFormats) {
    const int least = sensor_format_info(format).bayer ? 2 : 1;
    for (const int significant_bits : {0, 10, 12}) {
      if (significant_bits != 0 && format != SensorFormat::kMono16) continue;
      for (const BayerUse bayer : {BayerUse::kGreen, BayerUse::kLuminance}) {
        for (int width = least; width <= 70; ++width) {
          for (const int height : {least, 2, 3, 5}) {
            // Exactly as many bytes as there are: what reads beyond them, the address sanitizer sees.
            std::vector<std::byte> wire(sensor_image_bytes(format, width, height));
            for (auto& byte : wire) byte = static_cast<std::byte>(random());
            const bool wide = bytes_per_pixel(slice_format(format, significant_bits)) == 2;
            std::vector<std::byte> fast(static_cast<std::size_t>(width * height) * (wide ? 2 : 1));
            std::vector<std::byte> plain(fast.size());
            const WireImage image{format, significant_bits, bayer, width, height, wire};
            unpack(image, fast);
            unpack_reference(image, plain);
            ASSERT_EQ(fast, plain) << sensor_format_info(format).name << " " << width << " x " << height;
          }
        }
      }
    }
  }
}

TEST(Unpack, RefusesImagesThatAreTooShort) {
  std::vector<std::byte> slice(8);
  const auto wire = bytes({1, 2});
  test::expect_error(ErrorCode::kBadSlice, {"Mono12p", "2 x 1"}, [&] {
    unpack({SensorFormat::kMono12p, 0, BayerUse::kGreen, 2, 1, wire}, slice);
  });
  const auto enough = bytes({1, 2, 3});
  test::expect_error(ErrorCode::kBadSlice, {"Mono12p"}, [&] {
    unpack({SensorFormat::kMono12p, 0, BayerUse::kGreen, 2, 1, enough}, std::span(slice).first(3));
  });
}

TEST(Unpack, IsNotNeededWhereTheWireIsTheSlice) {
  for (const SensorFormat format :
       {SensorFormat::kMono8, SensorFormat::kMono10, SensorFormat::kMono12, SensorFormat::kMono16}) {
    EXPECT_FALSE(needs_unpacking(format, 0));
  }
  EXPECT_TRUE(needs_unpacking(SensorFormat::kMono16, 12));
  EXPECT_TRUE(needs_unpacking(SensorFormat::kMono10p, 0));
  EXPECT_TRUE(needs_unpacking(SensorFormat::kBayerBG8, 0));
}

}  // namespace
}  // namespace fvd
