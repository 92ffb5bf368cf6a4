#include "drivers/replay/significant_bits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>

namespace fvd {

namespace {

/// Pixels at 2^n - 1, none above, that make a plateau without a look at the other slices.
constexpr std::size_t kPlateauPixels = 16;
/// The most that 14 bits hold; above it all 16 are in use.
constexpr std::uint32_t kMost14Bits = 16'383;
constexpr std::uint32_t kMost16Bits = 65'535;

std::uint32_t most_of(int bits) { return (1U << static_cast<unsigned>(bits)) - 1U; }

std::span<const std::uint16_t> levels_of(const ImageFile& image) {
  return {reinterpret_cast<const std::uint16_t*>(image.samples.data()), image.samples.size() / 2};
}

/// n of a level 2^n - 1 that cameras have; 0 for any other.
int bits_of_plateau(std::uint32_t level) {
  for (const int bits : {8, 10, 12, 14}) {
    if (level == most_of(bits)) return bits;
  }
  return 0;
}

PixelFormat format_for(int bits) {
  if (bits <= 8) return PixelFormat::kMono8;
  if (bits <= 10) return PixelFormat::kMono10;
  return bits <= 12 ? PixelFormat::kMono12 : PixelFormat::kMono16;
}

GreyMapping of_bits(int bits, int shift) { return {format_for(bits), 2, bits, shift, 0.0, 1.0}; }

/// The level that real samples up to `most` mean as full scale.
double full_scale(double most) {
  constexpr std::array kScales{1.0, 255.0, 1023.0, 4095.0, 16'383.0, 32'767.0, 65'535.0};
  const auto* const scale = std::find_if(kScales.begin(), kScales.end(), [most](double s) { return most <= s; });
  return scale == kScales.end() || most < *scale / 8 ? most : *scale;
}

void apply_real(const GreyMapping& mapping, ImageFile& image) {
  const std::size_t count = image.samples.size() / sizeof(float);
  for (std::size_t i = 0; i < count; ++i) {  // in place: a level takes half of a sample's bytes
    float sample = 0;
    std::memcpy(&sample, &image.samples[i * sizeof sample], sizeof sample);
    const double level = std::rint((static_cast<double>(sample) - mapping.offset) * mapping.scale);
    if (!(level >= 0.0 && level <= kMost16Bits)) {
      throw ImageFileError("its sample " + std::to_string(sample) + " is outside the range of the other slices");
    }
    const auto value = static_cast<std::uint16_t>(level);
    std::memcpy(&image.samples[2 * i], &value, 2);
  }
  image.samples.resize(2 * count);
  image.bytes_per_sample = 2;
}

std::string samples_text(int bytes_per_sample) {
  return bytes_per_sample == 1 ? "8 bit" : bytes_per_sample == 2 ? "16 bit" : "real or signed numbers";
}

[[noreturn]] void refuse_level(const GreyMapping& mapping, std::uint32_t level) {
  throw ImageFileError("it has the level " + std::to_string(level) + ", but the slices' levels seemed to have " +
                       std::to_string(mapping.bits) + " significant bits" +
                       (mapping.shift > 0 ? " at the upper end" : "") +
                       ": say how many they have with --significant-bits, 16 for all");
}

}  // namespace

void GreySurvey::add(const ImageFile& image) {
  if (bytes_per_sample_ == 0) {
    bytes_per_sample_ = image.bytes_per_sample;
    declared_level_ = image.max_level;
  }
  if (image.bytes_per_sample != bytes_per_sample_) return;  // the reading of that slice says so
  if (bytes_per_sample_ == 2) {
    for (const std::uint16_t level : levels_of(image)) {
      set_bits_ |= level;
      if (level < most_) continue;
      at_most_ = level == most_ ? at_most_ + 1 : 1;
      most_ = level;
    }
  }
  if (bytes_per_sample_ != static_cast<int>(sizeof(float))) return;
  for (std::size_t i = 0; i < image.samples.size(); i += sizeof(float)) {
    float value = 0;
    std::memcpy(&value, &image.samples[i], sizeof value);
    if (!std::isfinite(value)) throw ImageFileError("a sample is not a finite number");
    least_real_ = real_seen_ ? std::min(least_real_, static_cast<double>(value)) : static_cast<double>(value);
    most_real_ = real_seen_ ? std::max(most_real_, static_cast<double>(value)) : static_cast<double>(value);
    real_seen_ = true;
  }
}

bool GreySurvey::decided() const {
  if (bytes_per_sample_ == 1) return true;
  if (bytes_per_sample_ != 2) return false;
  if (told_bits_ == 16 || (told_bits_ == 0 && declared_level_ != 0 && declared_level_ < static_cast<int>(kMost16Bits)))
    return true;
  return most_ > kMost14Bits && std::countr_zero(set_bits_) < 2;
}

bool GreySurvey::wants_all() const {
  if (bytes_per_sample_ != 2) return bytes_per_sample_ != 1;
  if (told_bits_ != 0 || decided() || std::countr_zero(set_bits_) >= 2) return false;
  return bits_of_plateau(most_) == 0 || at_most_ < kPlateauPixels;
}

GreyMapping GreySurvey::mapping() const {
  if (bytes_per_sample_ == 1) {
    if (told_bits_ > 8) {
      throw ImageFileError("its samples have 8 bits, not " + std::to_string(told_bits_));
    }
    return {};
  }
  if (bytes_per_sample_ != 2) {
    const double offset = std::min(0.0, least_real_);
    const double most = most_real_ - offset;
    double full = offset < 0.0 ? most : full_scale(most);  // what full scale is below 0 nobody says
    if (told_bits_ > 0) full = std::max(most, static_cast<double>(most_of(told_bits_)));
    return {PixelFormat::kMono16, bytes_per_sample_, 16, 0, offset, full > 0 ? kMost16Bits / full : 1.0};
  }
  const int zeros = set_bits_ == 0 ? 0 : std::countr_zero(set_bits_);
  if (told_bits_ != 0) {
    if (most_ <= most_of(told_bits_)) return of_bits(told_bits_, 0);
    if (zeros >= 16 - told_bits_) return of_bits(told_bits_, 16 - told_bits_);
    throw ImageFileError("it has levels up to " + std::to_string(most_) + " and no zero bits below, more than " +
                         std::to_string(told_bits_) + " significant bits hold");
  }
  if (declared_level_ != 0 && declared_level_ < static_cast<int>(kMost16Bits)) {
    const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(declared_level_)));
    const bool whole = static_cast<std::uint32_t>(declared_level_) == most_of(bits);
    return of_bits(whole ? bits : 16, 0);
  }
  if (set_bits_ == 0) return of_bits(16, 0);
  if (const int bits = bits_of_plateau(most_ >> static_cast<unsigned>(zeros)); bits != 0) return of_bits(bits, zeros);
  if (zeros < 2) return of_bits(16, 0);
  const int shift = std::min(8, zeros / 2 * 2);
  return of_bits(16 - shift, shift);
}

void apply(const GreyMapping& mapping, ImageFile& image) {
  if (image.bytes_per_sample != mapping.bytes_per_sample) {
    throw ImageFileError("its samples are " + samples_text(image.bytes_per_sample) + ", those of the first slice " +
                         samples_text(mapping.bytes_per_sample));
  }
  if (mapping.real()) return apply_real(mapping, image);
  if (mapping.bytes_per_sample == 1 || mapping.bits == 16) return;
  const auto shift = static_cast<unsigned>(mapping.shift);
  const auto up = static_cast<unsigned>(significant_bits(mapping.format) - mapping.bits);
  const auto down = static_cast<unsigned>(mapping.bits) - up;
  auto* const levels = reinterpret_cast<std::uint16_t*>(image.samples.data());
  const std::size_t count = image.samples.size() / 2;
  std::uint32_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t level = levels[i];
    const std::uint32_t value = level >> shift;
    if (value > most_of(mapping.bits) || value << shift != level) wrong = std::max(wrong, level);
    levels[i] = static_cast<std::uint16_t>(up == 0 ? value : value << up | value >> down);
  }
  if (wrong != 0) refuse_level(mapping, wrong);
  if (mapping.format != PixelFormat::kMono8) return;
  for (std::size_t i = 0; i < count; ++i) image.samples[i] = static_cast<std::byte>(levels[i]);
  image.samples.resize(count);
  image.bytes_per_sample = 1;
}

}  // namespace fvd
