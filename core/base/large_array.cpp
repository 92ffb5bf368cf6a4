#include "core/base/large_array.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <new>
#include <vector>

#include <sys/mman.h>

#include "core/base/mutex.hpp"

namespace fvd {

namespace detail {

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::align_val_t kCacheLine{64};

/// The start is moved to where a huge page may begin; what lies before it is given back.
void* map_pages(std::size_t bytes) {
  void* const mapped = ::mmap(nullptr, bytes + kHugePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  auto* const first = static_cast<std::byte*>(mapped);
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(first) % kHugePage) % kHugePage;
  if (before > 0) ::munmap(first, before);
  ::munmap(first + before + bytes, kHugePage - before);
  ::madvise(first + before, bytes, MADV_HUGEPAGE);  // without huge pages it is only slower
  return first + before;
}

/// To whole pages, as munmap() wants it.
std::size_t whole_pages(std::size_t bytes) {
  constexpr std::size_t kPage = 4096;
  return (bytes + kPage - 1) / kPage * kPage;
}

/// Released memory, for whoever asks for as much again.
class KeptMemory {
 public:
  /// nullptr if there is none of that size.
  void* take(std::size_t bytes) {
    const MutexLock lock(mutex_);
    const auto same = std::find_if(blocks_.rbegin(), blocks_.rend(), [&](const Block& b) { return b.bytes == bytes; });
    if (same == blocks_.rend()) return nullptr;
    void* const memory = same->memory;
    kept_bytes_ -= bytes;
    blocks_.erase(std::next(same).base());
    return memory;
  }

  void keep(void* memory, std::size_t bytes) noexcept {
    ::madvise(memory, bytes, MADV_FREE);  // without it the memory is kept under pressure too, as long as it is here
    const MutexLock lock(mutex_);
    blocks_.push_back({memory, bytes});
    kept_bytes_ += bytes;
    while (kept_bytes_ > kMostKeptBytes || blocks_.size() == blocks_.capacity()) release_oldest();
  }

  void release_all() noexcept {
    const MutexLock lock(mutex_);
    while (!blocks_.empty()) release_oldest();
  }

 private:
  static constexpr std::size_t kMostBlocks = 64;
  struct Block {
    void* memory;
    std::size_t bytes;
  };
  void release_oldest() noexcept FVD_REQUIRES(mutex_) {
    ::munmap(blocks_.front().memory, blocks_.front().bytes);
    kept_bytes_ -= blocks_.front().bytes;
    blocks_.erase(blocks_.begin());
  }
  static std::vector<Block> no_blocks() {
    std::vector<Block> blocks;
    blocks.reserve(kMostBlocks);  // keep() may not throw
    return blocks;
  }

  Mutex mutex_;
  std::vector<Block> blocks_ FVD_GUARDED_BY(mutex_) = no_blocks();  // oldest first
  std::size_t kept_bytes_ FVD_GUARDED_BY(mutex_) = 0;
};

/// Never destroyed: arrays with static storage may outlive what is.
KeptMemory& kept_memory() {
  static KeptMemory& kept = *new KeptMemory;
  return kept;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  if (bytes < kHugePage) return ::operator new(bytes, kCacheLine);
  void* const kept = kept_memory().take(whole_pages(bytes));
  return kept != nullptr ? kept : map_pages(whole_pages(bytes));
}

void release_large(void* memory, std::size_t bytes) noexcept {
  if (bytes >= kHugePage) {
    kept_memory().keep(memory, whole_pages(bytes));
  } else {
    ::operator delete(memory, kCacheLine);
  }
}

}  // namespace detail

void release_kept_memory() noexcept { detail::kept_memory().release_all(); }

}  // namespace fvd
