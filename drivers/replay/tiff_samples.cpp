#include "drivers/replay/tiff_samples.hpp"

#include <cstring>

namespace fvd {

namespace {

template <typename Sample>
void to_floats(const std::byte* in, std::size_t count, std::byte* out) {
  for (std::size_t i = 0; i < count; ++i) {
    Sample sample;
    std::memcpy(&sample, in + i * sizeof sample, sizeof sample);
    const auto value = static_cast<float>(sample);
    std::memcpy(out + i * sizeof value, &value, sizeof value);
  }
}

void unpack_bits(const std::byte* in, std::size_t count, int bits, std::byte* out) {
  std::uint32_t held = 0;
  int held_bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (held_bits < bits) {
      held = held << 8U | std::to_integer<std::uint32_t>(*in++);
      held_bits += 8;
    }
    held_bits -= bits;
    const auto value = static_cast<std::uint16_t>(held >> static_cast<unsigned>(held_bits));
    held &= (1U << static_cast<unsigned>(held_bits)) - 1U;
    std::memcpy(out + 2 * i, &value, 2);
  }
}

}  // namespace

bool TiffSamples::readable() const {
  if (is_unsigned()) return (bits_ >= 8 && bits_ <= 16) || bits_ == 32;
  if (format_ == SAMPLEFORMAT_INT) return bits_ == 8 || bits_ == 16 || bits_ == 32;
  return format_ == SAMPLEFORMAT_IEEEFP && (bits_ == 32 || bits_ == 64);
}

int TiffSamples::bytes() const {
  if (packed()) return 2;
  return plain() ? bits_ / 8 : static_cast<int>(sizeof(float));
}

void TiffSamples::spread(const std::byte* in, std::size_t count, std::vector<std::byte>& out) const {
  out.resize(count * static_cast<std::size_t>(bytes()));
  if (plain()) {
    std::memcpy(out.data(), in, out.size());
  } else if (packed()) {
    unpack_bits(in, count, bits_, out.data());
  } else if (is_unsigned()) {
    to_floats<std::uint32_t>(in, count, out.data());
  } else if (format_ == SAMPLEFORMAT_IEEEFP) {
    bits_ == 32 ? to_floats<float>(in, count, out.data()) : to_floats<double>(in, count, out.data());
  } else if (bits_ == 8) {
    to_floats<std::int8_t>(in, count, out.data());
  } else {
    bits_ == 16 ? to_floats<std::int16_t>(in, count, out.data()) : to_floats<std::int32_t>(in, count, out.data());
  }
}

}  // namespace fvd
