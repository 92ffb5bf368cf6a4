#include "drivers/replay/text_encoding.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

#include "core/base/error.hpp"

namespace fvd {

namespace {

void append(std::string& text, std::uint32_t code) {
  const auto byte = [&text](std::uint32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6U));
    byte(0x80 | (code & 0x3FU));
  } else {
    byte(0xE0 | (code >> 12U));
    byte(0x80 | ((code >> 6U) & 0x3FU));
    byte(0x80 | (code & 0x3FU));
  }
}

std::string from_utf16(const std::string& bytes, bool big_endian) {
  if (bytes.size() % 2 != 0) {
    throw Error(ErrorCode::kBadInput, "is UTF-16 text that ends within a character: it was cut off");
  }
  std::string text;
  for (std::size_t i = 2; i < bytes.size(); i += 2) {
    const auto high = static_cast<unsigned char>(bytes[big_endian ? i : i + 1]);
    const auto low = static_cast<unsigned char>(bytes[big_endian ? i + 1 : i]);
    const auto code = static_cast<std::uint32_t>(high << 8U | low);
    if (code >= 0xD800 && code < 0xE000) {  // half of a pair: beyond what numbers and units need
      text += '?';
    } else {
      append(text, code);
    }
  }
  return text;
}

}  // namespace

std::string to_utf8(const std::string& bytes) {
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes, false);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes, true);
  if (bytes.find('\0') != std::string::npos) {
    throw Error(ErrorCode::kBadInput,
                "holds NUL bytes: it is no text, or UTF-16 without a byte order mark; save it as "
                "UTF-8");
  }
  return bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
}

std::string printable(const std::string& text) {
  constexpr std::size_t kMaxLength = 40;
  std::string result;
  for (const char c : text.substr(0, kMaxLength)) {
    if (c >= ' ' && c <= '~') {
      result += c;
      continue;
    }
    std::array<char, 5> hex{};
    std::snprintf(hex.data(), hex.size(), "\\x%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    result += hex.data();
  }
  return text.size() > kMaxLength ? result + "..." : result;
}

}  // namespace fvd
