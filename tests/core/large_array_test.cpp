#include "core/large_array.hpp"

#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

namespace fvd {
namespace {

class ALargeArray : public testing::TestWithParam<std::size_t> {};

TEST_P(ALargeArray, IsZeroAlignedAndWritableToItsEnd) {
  const std::size_t size = GetParam();
  for (int round = 0; round < 2; ++round) {  // the second time from memory that was given back
    LargeArray<std::uint8_t> array(size);
    ASSERT_EQ(array.size(), size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0U);
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_EQ(array[i], 0) << i;
      array[i] = 0xAB;
    }
  }
}

constexpr std::size_t kHugePage = std::size_t{2} << 20;
INSTANTIATE_TEST_SUITE_P(AroundAHugePage, ALargeArray,
                         testing::Values(1, 63, 4097, kHugePage - 1, kHugePage, kHugePage + 1, 3 * kHugePage + 4095));

TEST(LargeArray, OfNothingIsEmpty) {
  EXPECT_EQ(LargeArray<int>().data(), nullptr);
  EXPECT_EQ(LargeArray<int>(0).size(), 0U);
}

TEST(LargeArray, Moves) {
  LargeArray<int> from(1'000'000);
  from[999'999] = 7;
  const int* memory = from.data();
  LargeArray<int> to(std::move(from));
  EXPECT_EQ(to.data(), memory);
  EXPECT_EQ(from.size(), 0U);  // NOLINT(bugprone-use-after-move): what is left is told
  LargeArray<int> third(3);
  third = std::move(to);
  EXPECT_EQ(third[999'999], 7);
}

}  // namespace
}  // namespace fvd
