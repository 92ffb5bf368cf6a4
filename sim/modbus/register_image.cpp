#include "sim/modbus/register_image.hpp"

#include <algorithm>

namespace fvd::sim {

bool RegisterImage::readable(int first, std::size_t count) const {
  if (index(first) + count > kSize) return false;
  return std::all_of(access_.begin() + first, access_.begin() + first + static_cast<std::ptrdiff_t>(count),
                     [](Access access) { return access != Access::kNone; });
}

bool RegisterImage::writable(int first, std::size_t count) const {
  if (index(first) + count > kSize) return false;
  return std::all_of(access_.begin() + first, access_.begin() + first + static_cast<std::ptrdiff_t>(count),
                     [](Access access) { return access == Access::kReadWrite; });
}

std::int32_t RegisterImage::value(int at) const {
  const int high = low_word_first_ ? at + 1 : at;
  const int low = low_word_first_ ? at : at + 1;
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(word(high)) << 16U) | word(low));
}

void RegisterImage::set_value(int at, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  set_word(low_word_first_ ? at + 1 : at, bits >> 16U);
  set_word(low_word_first_ ? at : at + 1, bits & 0xFFFFU);
}

void RegisterImage::copy_out(int first, std::span<std::uint16_t> words) const {
  std::copy_n(words_.begin() + first, words.size(), words.begin());
}

void RegisterImage::copy_in(int first, std::span<const std::uint16_t> words) {
  std::copy(words.begin(), words.end(), words_.begin() + first);
}

}  // namespace fvd::sim
