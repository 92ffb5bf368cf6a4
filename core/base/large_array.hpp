#pragma once

/// Memory for whole images.

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace fvd {

namespace detail {
/// 64-byte aligned; nullptr for 0 bytes. Throws std::bad_alloc. context: thread-safe, as the next.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void release_large(void* memory, std::size_t bytes) noexcept;

/// Bytes of released memory that are kept at most for the next array of the same size.
inline constexpr std::size_t kMostKeptBytes = std::size_t{1} << 30;
}  // namespace detail

/// Gives the operating system back what has been kept. context: thread-safe.
void release_kept_memory() noexcept;

/// A fixed number of plain values, unset at first, aligned to 64 bytes. From 2 MiB up the kernel is asked for huge
/// pages (madvise(2), MADV_HUGEPAGE), and a page costs nothing until the first thread writes to it. A surface of 5
/// million points is 30 000 ordinary pages: to get them takes as long as to compute the heights.
///
/// What one scan releases the next, of the same size, gets again: clean pages are a fifth of the time that the heights
/// take. Until then the kernel may have it back when memory is short (MADV_FREE); it still counts as resident.
template <typename T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  /// Throws std::bad_alloc.
  explicit LargeArray(std::size_t size)
      : size_(size), data_(static_cast<T*>(detail::allocate_large(size * sizeof(T)))) {}
  LargeArray(LargeArray&& other) noexcept
      : size_(std::exchange(other.size_, 0)), data_(std::exchange(other.data_, nullptr)) {}
  LargeArray& operator=(LargeArray&& other) noexcept {
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
    return *this;
  }
  LargeArray(const LargeArray&) = delete;
  LargeArray& operator=(const LargeArray&) = delete;
  ~LargeArray() { detail::release_large(data_, size_ * sizeof(T)); }

  [[nodiscard]] T* data() noexcept { return data_; }
  [[nodiscard]] const T* data() const noexcept { return data_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }
  [[nodiscard]] std::span<const T> values() const noexcept { return {data_, size_}; }

 private:
  std::size_t size_ = 0;
  T* data_ = nullptr;
};

}  // namespace fvd
