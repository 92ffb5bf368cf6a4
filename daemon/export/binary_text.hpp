#pragma once

/// Bytes of binary formats, collected and given on in large pieces.

#include <bit>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

#include "daemon/export/durable_file.hpp"

namespace fvd {

/// Collects bytes; flush() gives on what is left.
class BinaryText {
 public:
  explicit BinaryText(const ByteSink& sink) : sink_(sink), bytes_(kPiece_bytes) {}

  /// A number in little-endian order.
  template <typename T>
  void add(T value) {
    static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
    if (used_ + sizeof value > kPiece_bytes) flush();
    std::memcpy(bytes_.data() + used_, &value, sizeof value);
    used_ += sizeof value;
  }
  void add_text(std::string_view text) {
    if (used_ + text.size() > kPiece_bytes) flush();
    if (text.size() > kPiece_bytes) return sink_(text);
    std::memcpy(bytes_.data() + used_, text.data(), text.size());
    used_ += text.size();
  }
  void flush() {
    if (used_ > 0) sink_({bytes_.data(), used_});
    used_ = 0;
  }

 private:
  static constexpr std::size_t kPiece_bytes = std::size_t{1} << 18U;

  const ByteSink& sink_;
  std::vector<char> bytes_;
  std::size_t used_ = 0;
};

}  // namespace fvd
