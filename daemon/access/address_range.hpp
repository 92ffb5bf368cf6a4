#pragma once

/// Internet addresses and ranges of them, as texts and as bits.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fvd {

/// In network order; an IPv4 address a.b.c.d as ::ffff:a.b.c.d, in which form a listener of both families sees it too.
using AddressBytes = std::array<std::uint8_t, 16>;

/// "192.168.1.10", "fe80::1", also with a zone ("fe80::1%eth0"), which is left out. Nothing for any other text.
[[nodiscard]] std::optional<AddressBytes> address_bytes(std::string_view text);

/// 127.0.0.0/8 or ::1.
[[nodiscard]] bool is_loopback(const AddressBytes& address) noexcept;

/// The addresses that share their first bits.
class AddressRange {
 public:
  /// "192.168.1.10", "192.168.1.0/24", "fd00::/8". Nothing for any other text, and where bits behind the prefix are
  /// set: 192.168.1.10/24 may mean one address or 256.
  [[nodiscard]] static std::optional<AddressRange> parse(std::string_view text);

  [[nodiscard]] bool contains(const AddressBytes& address) const noexcept;
  /// All addresses of IPv4, or all there are.
  [[nodiscard]] bool is_everybody() const noexcept;
  /// Of 128; an IPv4 prefix counts 96 more.
  [[nodiscard]] int prefix_bits() const noexcept { return prefix_bits_; }

  bool operator==(const AddressRange&) const = default;

 private:
  AddressBytes first_{};
  int prefix_bits_ = 128;
};

}  // namespace fvd
