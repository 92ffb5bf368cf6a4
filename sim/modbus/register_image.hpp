#pragma once

/// The registers of a device by PDU address, and the access to each.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fvd::sim {

/// 32-bit values take two registers, the high word first unless said otherwise. context: one thread.
class RegisterImage {
 public:
  enum class Access : std::uint8_t { kNone, kReadOnly, kReadWrite };

  RegisterImage() : words_(kSize), access_(kSize, Access::kNone) {}

  /// first + count <= 65536; a later area overrides an earlier one where they overlap.
  void add_area(int first, int count, Access access) {
    for (int at = first; at < first + count; ++at) access_[index(at)] = access;
  }
  [[nodiscard]] bool readable(int first, std::size_t count) const;
  [[nodiscard]] bool writable(int first, std::size_t count) const;

  [[nodiscard]] std::uint16_t word(int at) const { return words_[index(at)]; }
  void set_word(int at, unsigned value) { words_[index(at)] = static_cast<std::uint16_t>(value); }
  [[nodiscard]] std::int32_t value(int at) const;
  void set_value(int at, std::int32_t value);
  /// Of values that are read and set from now on; what lies in the image stays as it is.
  void set_low_word_first(bool low_word_first) { low_word_first_ = low_word_first; }

  void copy_out(int first, std::span<std::uint16_t> words) const;
  void copy_in(int first, std::span<const std::uint16_t> words);
  void clear() { words_.assign(kSize, 0); }

 private:
  static constexpr std::size_t kSize = 0x10000;
  static std::size_t index(int at) { return static_cast<std::size_t>(at); }

  std::vector<std::uint16_t> words_;
  std::vector<Access> access_;
  bool low_word_first_ = false;
};

/// The range of registers of one write.
struct Written {
  int first = 0;
  int count = 0;
  [[nodiscard]] bool word(int at) const { return at >= first && at < first + count; }
  /// Either half of a 32-bit value.
  [[nodiscard]] bool value(int at) const { return word(at) || word(at + 1); }
};

}  // namespace fvd::sim
