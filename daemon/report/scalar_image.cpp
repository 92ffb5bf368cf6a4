#include "daemon/report/scalar_image.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/base/units.hpp"

namespace fvd {

namespace {

constexpr double kLeastSpan = 1e-3;      // 1 nm
constexpr double kLeastRelative = 1e-6;  // what float32 can tell apart

}  // namespace

int shrink_factor(int width, int height, int most) noexcept {
  return std::max(1, (std::max(width, height) + most - 1) / most);
}

ScalarImage shrunk_um(const PlaneView<const float>& metres, int most) {
  const int factor = shrink_factor(metres.width, metres.height, most);
  ScalarImage image{(metres.width + factor - 1) / factor, (metres.height + factor - 1) / factor, {}};
  image.values.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int top = 0; top < metres.height; top += factor) {
    const int bottom = std::min(top + factor, metres.height);
    for (int left = 0; left < metres.width; left += factor) {
      const int right = std::min(left + factor, metres.width);
      double sum_m = 0.0;
      int valid = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) {
          const float value = metres.at(x, y);
          if (std::isnan(value)) continue;
          sum_m += static_cast<double>(value);
          ++valid;
        }
      }
      const bool hole = 2 * valid < (bottom - top) * (right - left);
      image.values.push_back(hole ? std::numeric_limits<float>::quiet_NaN()
                                  : static_cast<float>(sum_m / valid / kMetresPerMicrometer));
    }
  }
  return image;
}

ValueRange robust_range(const ScalarImage& image, double fraction) {
  std::vector<float> valid;
  std::copy_if(image.values.begin(), image.values.end(), std::back_inserter(valid),
               [](float value) { return !std::isnan(value); });
  if (valid.empty()) return {};
  const auto quantile = [&valid](double share) {
    const auto place =
        valid.begin() + static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(valid.size() - 1)));
    std::nth_element(valid.begin(), place, valid.end());
    return static_cast<double>(*place);
  };
  const double low = quantile(fraction);
  const double high = quantile(1.0 - fraction);
  const double least = std::max(kLeastSpan, kLeastRelative * std::abs(high));
  if (high - low >= least) return {low, high, true};
  const double middle = (low + high) / 2.0;
  return {middle - 5.0 * least, middle + 5.0 * least, true};
}

}  // namespace fvd
