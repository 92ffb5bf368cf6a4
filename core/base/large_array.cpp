#include "core/base/large_array.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <new>

#include <sys/mman.h>

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

}  // namespace

void* allocate_large(std::size_t bytes, KeptPages* pages) {
  if (bytes == 0) return nullptr;
  if (bytes < kHugePage) return ::operator new(bytes, kCacheLine);
  void* const kept = pages != nullptr ? pages->take(whole_pages(bytes)) : nullptr;
  return kept != nullptr ? kept : map_pages(whole_pages(bytes));
}

void release_large(void* memory, std::size_t bytes, KeptPages* pages) noexcept {
  if (bytes < kHugePage) {
    ::operator delete(memory, kCacheLine);
  } else if (pages != nullptr) {
    pages->keep(memory, whole_pages(bytes));
  } else {
    ::munmap(memory, whole_pages(bytes));
  }
}

}  // namespace detail

namespace {
constexpr std::size_t kMaxBlocks = 64;
}

KeptPages::KeptPages(std::size_t most_kept_bytes) : most_kept_bytes_(most_kept_bytes) {
  const MutexLock lock(mutex_);
  blocks_.reserve(kMaxBlocks);  // keep() may not throw
}

KeptPages::~KeptPages() { release(); }

std::size_t KeptPages::kept_bytes() const {
  const MutexLock lock(mutex_);
  return kept_bytes_;
}

void KeptPages::release() noexcept {
  const MutexLock lock(mutex_);
  while (!blocks_.empty()) release_oldest();
}

void* KeptPages::take(std::size_t bytes) {
  const MutexLock lock(mutex_);
  const auto same = std::find_if(blocks_.rbegin(), blocks_.rend(), [&](const Block& b) { return b.bytes == bytes; });
  if (same == blocks_.rend()) return nullptr;
  void* const memory = same->memory;
  kept_bytes_ -= bytes;
  blocks_.erase(std::next(same).base());
  return memory;
}

void KeptPages::keep(void* memory, std::size_t bytes) noexcept {
  ::madvise(memory, bytes, MADV_FREE);  // without it the memory is kept under pressure too, as long as it is here
  const MutexLock lock(mutex_);
  blocks_.push_back({memory, bytes});
  kept_bytes_ += bytes;
  while (kept_bytes_ > most_kept_bytes_ || blocks_.size() == blocks_.capacity()) release_oldest();
}

void KeptPages::release_oldest() noexcept {
  ::munmap(blocks_.front().memory, blocks_.front().bytes);
  kept_bytes_ -= blocks_.front().bytes;
  blocks_.erase(blocks_.begin());
}

}  // namespace fvd
