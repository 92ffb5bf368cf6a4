#include "core/focus/grey_statistics.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fvd {

namespace {

constexpr double kMaxSaturatedShare = 0.001;  // above it the true brightness cannot be computed
constexpr double kMaxExposureFactor = 8.0;
constexpr double kSaturatedExposureFactor = 0.25;  // of an image that is more saturated than that

template <typename Pixel>
std::vector<std::uint64_t> histogram(PlaneView<const Pixel> image, int levels) {
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(levels));
  for (int y = 0; y < image.height; ++y) {
    const Pixel* row = image.row(y);
    for (int x = 0; x < image.width; ++x) ++counts[std::min<std::size_t>(row[x], counts.size() - 1)];
  }
  return counts;
}

}  // namespace

GreyStatistics grey_statistics(const ImageView& image) {
  const int levels = max_grey_level(image.format) + 1;
  const auto counts = bytes_per_pixel(image.format) == 1 ? histogram(image.as<std::uint8_t>(), levels)
                                                         : histogram(image.as<std::uint16_t>(), levels);
  const double total = static_cast<double>(image.width) * image.height;
  GreyStatistics grey;
  grey.min = levels;
  double sum = 0.0;
  double below = 0.0;
  int* const levels_of[] = {&grey.p01, &grey.p50, &grey.p99, &grey.p999};
  const double shares[] = {0.01, 0.5, 0.99, 0.999};
  std::size_t next = 0;
  for (int level = 0; level < levels; ++level) {
    const auto count = static_cast<double>(counts[static_cast<std::size_t>(level)]);
    if (count == 0.0) continue;
    grey.min = std::min(grey.min, level);
    grey.max = level;
    sum += count * level;
    below += count;
    for (; next < 4 && below >= shares[next] * total; ++next) *levels_of[next] = level;
  }
  grey.mean = sum / total;
  grey.saturated_fraction = static_cast<double>(counts.back()) / total;
  return grey;
}

double exposure_factor(const GreyStatistics& grey, PixelFormat format, double target) {
  if (grey.saturated_fraction > kMaxSaturatedShare) return kSaturatedExposureFactor;
  return std::min(kMaxExposureFactor, target * max_grey_level(format) / std::max(grey.p999, 1));
}

}  // namespace fvd
