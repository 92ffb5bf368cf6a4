#pragma once

/// The field Range (RFC 9110, 14.2): one range of bytes.

#include <cstdint>
#include <string_view>
#include <variant>

namespace fvd {

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;  ///< included; first <= last < size
  [[nodiscard]] std::uint64_t bytes() const noexcept { return last - first + 1; }
  bool operator==(const ByteRange&) const = default;
};

/// The whole is sent: no range of bytes, several of them, or none that can be read.
struct NoRange {
  bool operator==(const NoRange&) const = default;
};
/// No byte of the range is there: 416.
struct RangeBeyond {
  bool operator==(const RangeBeyond&) const = default;
};

/// range: "bytes=0-99", "bytes=100-", "bytes=-100" of so many bytes. Numbers of any length.
[[nodiscard]] std::variant<NoRange, ByteRange, RangeBeyond> byte_range(std::string_view range, std::uint64_t size);

}  // namespace fvd
