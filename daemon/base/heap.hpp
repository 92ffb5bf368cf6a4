#pragma once

/// How much of the system's memory the heap keeps, and how much of that is in use.

#include <cstdint>

namespace fvd {

/// From here on a heap keeps little of what was freed, and there are few heaps: memory stays within what a job needs,
/// however many jobs ran before. context: before any other thread exists.
void bound_heap() noexcept;

/// Without the images of 2 MiB and more, which have pages of their own (core/base/large_array).
struct HeapUse {
  std::uint64_t in_use_bytes = 0;  ///< taken and not freed
  std::uint64_t held_bytes = 0;    ///< of the system: in use, or kept for what is taken next
};

/// context: thread-safe; who allocates waits meanwhile.
[[nodiscard]] HeapUse heap_use() noexcept;

}  // namespace fvd
