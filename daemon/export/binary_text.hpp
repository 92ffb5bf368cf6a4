#pragma once

/// Bytes of binary formats, collected and given on in large pieces.

#include <bit>
#include <string>
#include <type_traits>

#include "daemon/export/durable_file.hpp"

namespace fvd {

/// Collects bytes; flush() gives on what is left.
class BinaryText {
 public:
  explicit BinaryText(const ByteSink& sink) : sink_(sink) { bytes_.reserve(kPiece_bytes + kSlack_bytes); }

  /// A number in little-endian order.
  template <typename T>
  void add(T value) {
    static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
    add_text({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void add_text(std::string_view text) {
    bytes_ += text;
    if (bytes_.size() >= kPiece_bytes) flush();
  }
  void flush() {
    if (!bytes_.empty()) sink_(bytes_);
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kPiece_bytes = std::size_t{1} << 18U;
  static constexpr std::size_t kSlack_bytes = 4096;

  const ByteSink& sink_;
  std::string bytes_;
};

}  // namespace fvd
