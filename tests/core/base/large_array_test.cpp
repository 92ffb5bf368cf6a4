#include "core/base/large_array.hpp"

#include <cstdint>
#include <memory>
#include <utility>

#include <gtest/gtest.h>
#include <sys/mman.h>

namespace fvd {
namespace {

bool is_mapped(const std::uint8_t* memory) {
  unsigned char resident = 0;
  return ::mincore(const_cast<std::uint8_t*>(memory), 1, &resident) == 0;
}

class ALargeArray : public testing::TestWithParam<std::size_t> {};

TEST_P(ALargeArray, IsAlignedAndWritableToItsEnd) {
  const std::size_t size = GetParam();
  const auto pages = std::make_shared<KeptPages>(4 * size);
  for (int round = 0; round < 3; ++round) {  // without kept pages, with none kept yet, from those
    LargeArray<std::uint8_t> array(size, round == 0 ? nullptr : pages);
    ASSERT_EQ(array.size(), size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0U);
    for (std::size_t i = 0; i < size; ++i) array[i] = static_cast<std::uint8_t>(i % 251);
    for (std::size_t i = 0; i < size; ++i) ASSERT_EQ(array[i], i % 251) << i;
  }
}

constexpr std::size_t kHugePage = std::size_t{2} << 20;
INSTANTIATE_TEST_SUITE_P(AroundAHugePage, ALargeArray,
                         testing::Values(1, 63, 4097, kHugePage - 1, kHugePage, kHugePage + 1, 3 * kHugePage + 4095));

TEST(LargeArray, OfNothingIsEmpty) {
  EXPECT_EQ(LargeArray<int>().data(), nullptr);
  EXPECT_EQ(LargeArray<int>(0).size(), 0U);
}

TEST(LargeArray, TakesThePagesThatOneOfItsSizeReleased) {
  constexpr std::size_t kSize = 2 * kHugePage + 12345;
  const auto pages = std::make_shared<KeptPages>(100 * kSize);
  const std::uint8_t* memory = nullptr;
  {
    LargeArray<std::uint8_t> first(kSize, pages);
    memory = first.data();
    const LargeArray<std::uint8_t> other(kSize + 4096, pages);
  }
  EXPECT_GE(pages->kept_bytes(), 2 * kSize);
  const LargeArray<std::uint8_t> second(kSize, pages);
  EXPECT_EQ(second.data(), memory);
  const LargeArray<std::uint8_t> third(kSize, pages);
  EXPECT_NE(third.data(), memory);
}

TEST(LargeArray, GivesItsPagesBackWithoutAPlaceToKeepThem) {
  constexpr std::size_t kSize = 2 * kHugePage + 54321;
  const std::uint8_t* memory = nullptr;
  {
    const LargeArray<std::uint8_t> array(kSize);
    memory = array.data();
    ASSERT_TRUE(is_mapped(memory));
  }
  EXPECT_FALSE(is_mapped(memory));
}

TEST(KeptPages, AreGivenBackWhenAskedAndAtTheEnd) {
  constexpr std::size_t kSize = 2 * kHugePage + 54321;
  const std::uint8_t* memory = nullptr;
  {
    const auto pages = std::make_shared<KeptPages>(100 * kSize);
    for (int round = 0; round < 2; ++round) {
      {
        const LargeArray<std::uint8_t> array(kSize, pages);
        memory = array.data();
      }
      ASSERT_TRUE(is_mapped(memory));
      if (round > 0) break;
      pages->release();
      EXPECT_FALSE(is_mapped(memory));
      EXPECT_EQ(pages->kept_bytes(), 0U);
    }
  }
  EXPECT_FALSE(is_mapped(memory));
}

TEST(KeptPages, AreNoMoreThanTheLimitTheOldestGoFirst) {
  constexpr std::size_t kSize = 4 * kHugePage;
  const auto pages = std::make_shared<KeptPages>(2 * kSize - 1);
  const std::uint8_t* oldest = nullptr;
  {
    const LargeArray<std::uint8_t> first(kSize, pages);
    oldest = first.data();
  }
  ASSERT_TRUE(is_mapped(oldest));
  { const LargeArray<std::uint8_t> second(kSize + 4096, pages); }
  EXPECT_FALSE(is_mapped(oldest));
  EXPECT_EQ(pages->kept_bytes(), kSize + 4096);
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
