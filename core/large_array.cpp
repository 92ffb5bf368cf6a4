#include "core/large_array.hpp"

#include <cstdint>
#include <cstring>
#include <new>

#include <sys/mman.h>

namespace fvd::detail {

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::align_val_t kCacheLine{64};

/// Fresh pages are zero. The start is moved to where a huge page may begin; what lies before it is given back.
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

void* allocate_zeros(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  if (bytes >= kHugePage) return map_pages(whole_pages(bytes));
  return std::memset(::operator new(bytes, kCacheLine), 0, bytes);
}

void release_zeros(void* memory, std::size_t bytes) noexcept {
  if (bytes >= kHugePage) {
    ::munmap(memory, whole_pages(bytes));
  } else {
    ::operator delete(memory, kCacheLine);
  }
}

}  // namespace fvd::detail
