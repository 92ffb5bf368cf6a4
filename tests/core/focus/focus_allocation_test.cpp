/// The streaming stack takes all its memory before the first slice. This program counts every allocation it makes.

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/focus/streaming_focus_stack.hpp"
#include "core/runtime/worker_pool.hpp"
#include "gtest/gtest.h"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded > 0 ? rounded : alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
// Not inlined: beside an operator new that stays a call, g++ takes an inlined free() for a mismatch.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace fvd {
namespace {

template <typename Pixel>
void expect_no_allocation_in_push(PixelFormat format) {
  for (const int threads : {1, 2, 3}) {
    WorkerPool pool(threads);
    const long before_construction = allocations;
    StreamingFocusStack stack(70, 50, format, {}, pool);
    EXPECT_GT(allocations, before_construction) << "the counter does not count";
    const Plane<Pixel> slice(70, 50, 9);
    const ImageView view = image_view(slice.view(), format);
    const long before = allocations;
    for (int k = 0; k < 300; ++k) stack.push(view, k);
    EXPECT_EQ(allocations, before) << threads << " threads";
  }
}

TEST(StreamingFocusStack, AllocatesNothingWhileSlicesFlow) {
  expect_no_allocation_in_push<std::uint8_t>(PixelFormat::kMono8);
  expect_no_allocation_in_push<std::uint16_t>(PixelFormat::kMono12);
}

}  // namespace
}  // namespace fvd
