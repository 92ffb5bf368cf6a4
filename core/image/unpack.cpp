#include "core/image/unpack.hpp"

#include <cstdint>
#include <cstring>
#include <string>

#include "core/base/error.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace fvd {

namespace {

// --- packed formats ---

/// Pixels `first` to `count` of a stream; first is a multiple of the pixels that fill whole bytes.
using Spread = void (*)(const std::uint8_t* in, std::uint16_t* out, std::size_t first, std::size_t count);

template <unsigned kBits>
void spread_lsb_first(const std::uint8_t* in, std::uint16_t* out, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < count; ++i) {
    const std::size_t bit = i * kBits;
    const unsigned low = in[bit / 8];
    const unsigned high = in[bit / 8 + 1];
    out[i] = static_cast<std::uint16_t>(((low | (high << 8U)) >> (bit % 8)) & ((1U << kBits) - 1));
  }
}

void spread_gige(const std::uint8_t* in, std::uint16_t* out, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < count; ++i) {
    const std::uint8_t* pair = in + i / 2 * 3;
    out[i] =
        static_cast<std::uint16_t>(i % 2 == 0 ? (pair[0] << 4) | (pair[1] & 0xF) : (pair[2] << 4) | (pair[1] >> 4));
  }
}

#if defined(__x86_64__)
constexpr std::size_t kLanes = 8;

/// Every lane gets the two bytes its bits lie in; a product brings them to the upper end, a shift down again.
__attribute__((target("ssse3"))) void spread_10p_ssse3(const std::uint8_t* in, std::uint16_t* out, std::size_t,
                                                       std::size_t count) {
  const __m128i bytes = _mm_setr_epi8(0, 1, 1, 2, 2, 3, 3, 4, 5, 6, 6, 7, 7, 8, 8, 9);
  const __m128i up = _mm_setr_epi16(64, 16, 4, 1, 64, 16, 4, 1);
  for (std::size_t i = 0; i < count; i += kLanes, in += 10) {
    const __m128i raw = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in));
    const __m128i lanes = _mm_mullo_epi16(_mm_shuffle_epi8(raw, bytes), up);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), _mm_srli_epi16(lanes, 6));
  }
}

__attribute__((target("ssse3"))) void spread_12p_ssse3(const std::uint8_t* in, std::uint16_t* out, std::size_t,
                                                       std::size_t count) {
  const __m128i bytes = _mm_setr_epi8(0, 1, 1, 2, 3, 4, 4, 5, 6, 7, 7, 8, 9, 10, 10, 11);
  const __m128i up = _mm_setr_epi16(16, 1, 16, 1, 16, 1, 16, 1);
  for (std::size_t i = 0; i < count; i += kLanes, in += 12) {
    const __m128i raw = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in));
    const __m128i lanes = _mm_mullo_epi16(_mm_shuffle_epi8(raw, bytes), up);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), _mm_srli_epi16(lanes, 4));
  }
}

/// Even lanes hold middle byte and first, odd ones middle byte and last.
__attribute__((target("ssse3"))) void spread_gige_ssse3(const std::uint8_t* in, std::uint16_t* out, std::size_t,
                                                        std::size_t count) {
  const __m128i bytes = _mm_setr_epi8(1, 0, 1, 2, 4, 3, 4, 5, 7, 6, 7, 8, 10, 9, 10, 11);
  const __m128i upper = _mm_setr_epi16(0xFF0, 0xFFF, 0xFF0, 0xFFF, 0xFF0, 0xFFF, 0xFF0, 0xFFF);
  const __m128i lower = _mm_setr_epi16(0xF, 0, 0xF, 0, 0xF, 0, 0xF, 0);
  for (std::size_t i = 0; i < count; i += kLanes, in += 12) {
    const __m128i lanes = _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(in)), bytes);
    const __m128i value = _mm_or_si128(_mm_and_si128(_mm_srli_epi16(lanes, 4), upper), _mm_and_si128(lanes, lower));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), value);
  }
}

Spread if_ssse3(Spread vector) { return __builtin_cpu_supports("ssse3") != 0 ? vector : nullptr; }
#define FVD_IF_SSSE3(function) if_ssse3(function)
#else
constexpr std::size_t kLanes = 8;
#define FVD_IF_SSSE3(function) nullptr
#endif

/// The vector code reads 16 bytes for 8 pixels: it stops where they would reach beyond the image. The plain code reads
/// a byte behind its pixel, so the last pixels are done by themselves.
void spread(const WireImage& image, std::span<std::byte> slice, Spread vector, Spread plain, std::size_t bits) {
  constexpr std::size_t kReadBytes = 16;
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const auto* in = reinterpret_cast<const std::uint8_t*>(image.bytes.data());
  auto* out = reinterpret_cast<std::uint16_t*>(slice.data());
  const std::size_t bytes = (count * bits + 7) / 8;
  std::size_t done = 0;
  if (vector != nullptr && bytes >= kReadBytes) {
    done = ((bytes - kReadBytes) / bits + 1) * kLanes;  // 8 pixels are `bits` bytes
    done = done > count ? count / kLanes * kLanes : done;
    vector(in, out, 0, done);
  }
  const std::size_t safe = count > 4 ? (count - 4) / kLanes * kLanes : 0;
  if (safe > done) {
    plain(in, out, done, safe);
    done = safe;
  }
  // A copy with room behind it.
  std::uint8_t tail[64] = {};
  const std::size_t from = done / kLanes * bits;
  std::memcpy(tail, in + from, bytes - from);
  std::uint16_t last[2 * kLanes + 8];
  plain(tail, last, 0, count - done);
  std::memcpy(out + done, last, 2 * (count - done));
}

// --- mosaics ---

template <typename Pixel>
void green_row(const Pixel* up, const Pixel* row, const Pixel* down, int width, bool green_first, Pixel* out) {
  const auto mean = [&](int left, int x, int right) {
    return static_cast<Pixel>((unsigned{row[left]} + row[right] + up[x] + down[x] + 2U) / 4U);
  };
  // Both values for every pixel, then the one that belongs there: no jump in the loop.
  for (int x = 1; x < width - 1; ++x) {
    const Pixel between = mean(x - 1, x, x + 1);
    out[x] = ((x & 1) == 0) == green_first ? row[x] : between;
  }
  out[0] = green_first ? row[0] : mean(1, 0, 1);
  const int last = width - 1;
  out[last] = ((last & 1) == 0) == green_first ? row[last] : mean(last - 1, last, last - 1);
}

template <typename Pixel>
void luminance_row(const Pixel* row, const Pixel* down, int width, Pixel* out) {
  for (int x = 0; x < width - 1; ++x) {
    out[x] = static_cast<Pixel>((unsigned{row[x]} + row[x + 1] + down[x] + down[x + 1] + 2U) / 4U);
  }
  const int last = width - 1;
  out[last] = static_cast<Pixel>((unsigned{row[last]} + row[last - 1] + down[last] + down[last - 1] + 2U) / 4U);
}

template <typename Pixel>
void demosaic(const WireImage& image, std::span<std::byte> slice) {
  const auto* pixels = reinterpret_cast<const Pixel*>(image.bytes.data());
  auto* out = reinterpret_cast<Pixel*>(slice.data());
  const auto order = sensor_format_info(image.format).name.substr(5, 2);
  const bool green_first = order == "GR" || order == "GB";
  const std::ptrdiff_t stride = image.width;
  for (int y = 0; y < image.height; ++y) {
    const Pixel* row = pixels + y * stride;
    const Pixel* down = y + 1 < image.height ? row + stride : row - stride;
    if (image.bayer == BayerUse::kLuminance) {
      luminance_row(row, down, image.width, out + y * stride);
    } else {
      const Pixel* up = y > 0 ? row - stride : row + stride;
      green_row(up, row, down, image.width, green_first == (y % 2 == 0), out + y * stride);
    }
  }
}

void check(const WireImage& image, std::span<std::byte> slice) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const bool mosaic = sensor_format_info(image.format).bayer;
  const int least = mosaic ? 2 : 1;
  const auto out =
      pixels * static_cast<std::size_t>(bytes_per_pixel(slice_format(image.format, image.significant_bits)));
  if (image.width >= least && image.height >= least &&
      image.bytes.size() >= sensor_image_bytes(image.format, image.width, image.height) && slice.size() >= out) {
    return;
  }
  throw Error(ErrorCode::kBadSlice,
              "an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels of " +
                  std::string(sensor_format_info(image.format).name) + " cannot be made of " +
                  std::to_string(image.bytes.size()) + " bytes into " + std::to_string(slice.size()));
}

}  // namespace

bool needs_unpacking(SensorFormat format, int significant_bits) {
  const SensorFormatInfo info = sensor_format_info(format);
  return info.bayer || info.bits_per_pixel % 8 != 0 || (format == SensorFormat::kMono16 && significant_bits != 0);
}

void unpack(const WireImage& image, std::span<std::byte> slice) {
  check(image, slice);
  switch (image.format) {
    case SensorFormat::kMono10p:
      return spread(image, slice, FVD_IF_SSSE3(spread_10p_ssse3), spread_lsb_first<10>, 10);
    case SensorFormat::kMono12p:
      return spread(image, slice, FVD_IF_SSSE3(spread_12p_ssse3), spread_lsb_first<12>, 12);
    case SensorFormat::kMono12Packed:
      return spread(image, slice, FVD_IF_SSSE3(spread_gige_ssse3), spread_gige, 12);
    default:
      break;
  }
  const SensorFormatInfo info = sensor_format_info(image.format);
  if (info.bayer) return info.bits == 8 ? demosaic<std::uint8_t>(image, slice) : demosaic<std::uint16_t>(image, slice);
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!needs_unpacking(image.format, image.significant_bits)) {
    std::memcpy(slice.data(), image.bytes.data(), pixels * static_cast<std::size_t>(info.bits_per_pixel / 8));
    return;
  }
  const auto* in = reinterpret_cast<const std::uint16_t*>(image.bytes.data());
  auto* out = reinterpret_cast<std::uint16_t*>(slice.data());
  const int shift = 16 - image.significant_bits;
  for (std::size_t i = 0; i < pixels; ++i) out[i] = static_cast<std::uint16_t>(in[i] >> shift);
}

}  // namespace fvd
