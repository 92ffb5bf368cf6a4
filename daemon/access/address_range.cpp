#include "daemon/access/address_range.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace fvd {

namespace {

constexpr int kBits = 128;
constexpr int kBitsBeforeIpv4 = 96;
constexpr AddressBytes kIpv4Begin{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};
constexpr std::size_t kIpv4Offset = 12;

bool is_ipv4(const AddressBytes& address) noexcept {
  return std::equal(kIpv4Begin.begin(), kIpv4Begin.begin() + kIpv4Offset, address.begin());
}

/// The address with the bits behind the prefix cleared.
AddressBytes first_of(AddressBytes address, int prefix_bits) noexcept {
  for (int bit = prefix_bits; bit < kBits; ++bit) {
    auto& byte = address[static_cast<std::size_t>(bit / 8)];
    byte = static_cast<std::uint8_t>(byte & ~(0x80U >> static_cast<unsigned>(bit % 8)));
  }
  return address;
}

}  // namespace

std::optional<AddressBytes> address_bytes(std::string_view text) {
  const std::string plain(text.substr(0, text.find('%')));
  AddressBytes bytes = kIpv4Begin;
  in_addr ipv4{};
  if (::inet_pton(AF_INET, plain.c_str(), &ipv4) == 1) {
    std::memcpy(bytes.data() + kIpv4Offset, &ipv4, sizeof ipv4);
    return bytes;
  }
  if (::inet_pton(AF_INET6, plain.c_str(), bytes.data()) == 1) return bytes;
  return std::nullopt;
}

bool is_loopback(const AddressBytes& address) noexcept {
  if (is_ipv4(address)) return address[kIpv4Offset] == 127;
  AddressBytes one{};
  one.back() = 1;
  return address == one;
}

std::optional<AddressRange> AddressRange::parse(std::string_view text) {
  if (text.find('%') != std::string_view::npos) return std::nullopt;
  const auto slash = text.find('/');
  const auto address = address_bytes(text.substr(0, slash));
  if (!address) return std::nullopt;
  AddressRange range;
  range.first_ = *address;
  if (slash == std::string_view::npos) return range;
  const std::string_view digits = text.substr(slash + 1);
  const int before = text.find(':') == std::string_view::npos ? kBitsBeforeIpv4 : 0;
  int bits = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), bits);
  if (error != std::errc() || end != digits.data() + digits.size() || bits < 0 || bits > kBits - before) {
    return std::nullopt;
  }
  range.prefix_bits_ = before + bits;
  if (first_of(range.first_, range.prefix_bits_) != range.first_) return std::nullopt;
  return range;
}

bool AddressRange::is_everybody() const noexcept {
  return prefix_bits_ == 0 || (prefix_bits_ == kBitsBeforeIpv4 && is_ipv4(first_));
}

bool AddressRange::contains(const AddressBytes& address) const noexcept {
  return first_of(address, prefix_bits_) == first_;
}

}  // namespace fvd
