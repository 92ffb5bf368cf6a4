#include "daemon/base/heap.hpp"

#include <malloc.h>

namespace fvd {

namespace {

/// Each job's threads are new ones. With the standard eight heaps a core they come upon another one each time, and
/// years of jobs leave in each of them the most that any thread ever needed.
constexpr int kMostHeaps = 2;

/// From this size on a block has pages of its own, and a heap gives back what is free at its end. Both begin with this
/// value, but with each larger block that is freed the first rises to its size and the second to twice that, up to 32
/// and 64 MiB: once a picture was drawn each heap keeps 12 MiB, or nothing, as small blocks happen to lie at its end.
constexpr int kLargeBlock_bytes = 128 << 10;

}  // namespace

void bound_heap() noexcept {
  (void)::mallopt(M_ARENA_MAX, kMostHeaps);
  (void)::mallopt(M_MMAP_THRESHOLD, kLargeBlock_bytes);
  (void)::mallopt(M_TRIM_THRESHOLD, kLargeBlock_bytes);
}

HeapUse heap_use() noexcept {
  const struct mallinfo2 info = ::mallinfo2();
  return {info.uordblks + info.hblkhd, info.arena + info.hblkhd};
}

}  // namespace fvd
