#include "daemon/base/heap.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/daemon/surface_files/peak_memory.hpp"

namespace fvd {
namespace {

constexpr std::size_t kMib = std::size_t{1} << 20U;
constexpr std::size_t kSlack_bytes = kMib / 4;  // of what other threads and the test itself take

class AHeap : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kKeepsWhatIsFreed) GTEST_SKIP() << "a sanitizer has a heap of its own";
  }
  /// As those of pictures, rows and texts, which differ from job to job.
  static std::vector<std::string> blocks(int count, std::size_t bytes) {
    return std::vector<std::string>(static_cast<std::size_t>(count), std::string(bytes, 'x'));
  }
};

TEST_F(AHeap, TellsWhatIsInUse) {
  const HeapUse before = heap_use();
  auto taken = blocks(3, kMib);
  const HeapUse during = heap_use();
  taken = {};
  const HeapUse after = heap_use();

  EXPECT_GE(during.in_use_bytes, before.in_use_bytes + 3 * kMib);
  EXPECT_LE(during.in_use_bytes, before.in_use_bytes + 3 * kMib + kSlack_bytes);
  EXPECT_LE(after.in_use_bytes, before.in_use_bytes + kSlack_bytes);
  EXPECT_GE(during.held_bytes, during.in_use_bytes);
}

TEST_F(AHeap, KeepsNothingOfLargeBlocksOnceBounded) {
  bound_heap();
  const std::uint64_t before_bytes = heap_use().held_bytes;

  // Unbounded, a heap takes such blocks into itself from the second time on, and keeps them.
  for (int job = 0; job < 3; ++job) {
    (void)blocks(1, 8 * kMib);
    (void)blocks(4, kMib);
  }

  EXPECT_LE(heap_use().held_bytes, before_bytes + kSlack_bytes);
}

}  // namespace
}  // namespace fvd
