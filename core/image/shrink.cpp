#include "core/image/shrink.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace fvd {

namespace {

constexpr int kLargestNarrowFactor = 257;  // 257 levels of 255 are the most that 16 bit hold

template <typename Pixel>
std::int64_t count_saturated(PlaneView<const Pixel> image, int level) {
  std::int64_t total = 0;
  const auto least = static_cast<Pixel>(level);
  for (int y = 0; y < image.height; ++y) {
    const Pixel* row = image.row(y);
    std::uint32_t count = 0;
    for (int x = 0; x < image.width; ++x) count += row[x] >= least ? 1U : 0U;
    total += count;
  }
  return total;
}

/// Sum: holds `factor` levels.
template <typename Sum, typename Pixel>
void shrink_into(PlaneView<const Pixel> image, int factor, int shift, Plane<std::uint8_t>& out) {
  const auto area = static_cast<std::uint32_t>(factor) * static_cast<std::uint32_t>(factor);
  const int area_bits = std::has_single_bit(area) ? std::countr_zero(area) : -1;  // a division takes much longer
  const int used = out.width() * factor;
  std::vector<Sum> columns(static_cast<std::size_t>(used));
  for (int y = 0; y < out.height(); ++y) {
    std::fill(columns.begin(), columns.end(), Sum{0});
    Sum* sums = columns.data();
    for (int v = 0; v < factor; ++v) {
      const Pixel* row = image.row(y * factor + v);
      for (int x = 0; x < used; ++x) sums[x] = static_cast<Sum>(sums[x] + row[x]);
    }
    std::uint8_t* to = out.row(y);
    for (int x = 0; x < out.width(); ++x) {
      std::uint64_t sum = 0;
      for (int u = 0; u < factor; ++u) sum += sums[x * factor + u];
      const std::uint64_t mean = area_bits >= 0 ? sum >> area_bits : sum / area;
      to[x] = static_cast<std::uint8_t>(mean >> shift);
    }
  }
}

}  // namespace

ShrunkImage shrink(const ImageView& image, int factor) {
  ShrunkImage shrunk;
  shrunk.pixels = Plane<std::uint8_t>::unset(image.width / factor, image.height / factor);
  const int shift = significant_bits(image.format) - 8;
  const int full_scale = max_grey_level(image.format);
  if (bytes_per_pixel(image.format) == 2) {
    shrunk.saturated = count_saturated(image.as<std::uint16_t>(), full_scale);
    shrink_into<std::uint32_t>(image.as<std::uint16_t>(), factor, shift, shrunk.pixels);
    return shrunk;
  }
  shrunk.saturated = count_saturated(image.as<std::uint8_t>(), full_scale);
  if (factor <= kLargestNarrowFactor) {
    shrink_into<std::uint16_t>(image.as<std::uint8_t>(), factor, shift, shrunk.pixels);
  } else {
    shrink_into<std::uint32_t>(image.as<std::uint8_t>(), factor, shift, shrunk.pixels);
  }
  return shrunk;
}

int shrink_factor(int width, int height, int most_width, int most_height) noexcept {
  const int wanted = std::max({1, (width + most_width - 1) / most_width, (height + most_height - 1) / most_height});
  return std::min(wanted, std::max(1, std::min(width, height)));
}

}  // namespace fvd
