#pragma once

/// Memory for whole images.

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"

namespace fvd {

/// Pages that arrays gave back, for the next arrays of the same size: clean pages are a fifth of the time that the
/// heights of a scan take. Until then the kernel may have them back when memory is short (MADV_FREE); they still count
/// as resident. context: thread-safe.
class KeptPages {
 public:
  /// most_kept_bytes: limit of the sum; beyond it the oldest blocks are released first.
  explicit KeptPages(std::size_t most_kept_bytes);
  ~KeptPages();
  KeptPages(const KeptPages&) = delete;
  KeptPages& operator=(const KeptPages&) = delete;

  /// Bytes that are kept now.
  [[nodiscard]] std::size_t kept_bytes() const;
  /// Gives the operating system back what is kept.
  void release() noexcept;

  /// A kept block of exactly this size, which the caller now owns; nullptr if there is none. bytes: a multiple of the
  /// page size, 4096.
  [[nodiscard]] void* take(std::size_t bytes);
  /// Takes over a block that was mapped with mmap(2). bytes: as in take().
  void keep(void* memory, std::size_t bytes) noexcept;

 private:
  struct Block {
    void* memory;
    std::size_t bytes;
  };
  void release_oldest() noexcept FVD_REQUIRES(mutex_);

  const std::size_t most_kept_bytes_;
  mutable Mutex mutex_;
  std::vector<Block> blocks_ FVD_GUARDED_BY(mutex_);  // oldest first
  std::size_t kept_bytes_ FVD_GUARDED_BY(mutex_) = 0;
};

/// An array without one gives its pages back to the operating system.
using KeptPagesPtr = std::shared_ptr<KeptPages>;

namespace detail {
/// 64-byte aligned; nullptr for 0 bytes. pages may be null. Throws std::bad_alloc. context: thread-safe, as the next.
[[nodiscard]] void* allocate_large(std::size_t bytes, KeptPages* pages);
void release_large(void* memory, std::size_t bytes, KeptPages* pages) noexcept;
}  // namespace detail

/// A fixed number of plain values, uninitialised, aligned to 64 bytes. From 2 MiB up the kernel is asked for huge pages
/// (madvise(2), MADV_HUGEPAGE), and a page costs nothing until the first thread writes to it. A surface of 5 million
/// points takes 30 000 ordinary pages; to get these takes as long as to compute the heights.
/// context: one thread at a time; several may write to different elements.
template <typename T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  /// Throws std::bad_alloc.
  explicit LargeArray(std::size_t size, KeptPagesPtr pages = nullptr)
      : pages_(std::move(pages)),
        size_(size),
        data_(static_cast<T*>(detail::allocate_large(size * sizeof(T), pages_.get()))) {}
  LargeArray(LargeArray&& other) noexcept
      : pages_(std::move(other.pages_)),
        size_(std::exchange(other.size_, 0)),
        data_(std::exchange(other.data_, nullptr)) {}
  LargeArray& operator=(LargeArray&& other) noexcept {
    std::swap(pages_, other.pages_);
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
    return *this;
  }
  LargeArray(const LargeArray&) = delete;
  LargeArray& operator=(const LargeArray&) = delete;
  ~LargeArray() { detail::release_large(data_, size_ * sizeof(T), pages_.get()); }

  [[nodiscard]] T* data() noexcept { return data_; }
  [[nodiscard]] const T* data() const noexcept { return data_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] std::span<const T> values() const noexcept { return {data_, size_}; }

 private:
  KeptPagesPtr pages_;  // where the memory came from and goes back to; may be null
  std::size_t size_ = 0;
  T* data_ = nullptr;
};

}  // namespace fvd
