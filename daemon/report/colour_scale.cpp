#include "daemon/report/colour_scale.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fvd {

namespace {

std::array<std::uint32_t, 256> made(cv::ColormapTypes map) {
  cv::Mat levels(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i) levels.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat colours;
  cv::applyColorMap(levels, colours, map);
  std::array<std::uint32_t, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const auto& bgr = colours.at<cv::Vec3b>(0, i);
    table[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(bgr[2] << 16 | bgr[1] << 8 | bgr[0]);
  }
  return table;
}

}  // namespace

const std::array<std::uint32_t, 256>& colours_of(ColourScale scale) {
  static const auto viridis = made(cv::COLORMAP_VIRIDIS);
  static const auto magma = made(cv::COLORMAP_MAGMA);
  return scale == ColourScale::kViridis ? viridis : magma;
}

Raster coloured(const ScalarImage& image, const ValueRange& range, ColourScale scale) {
  const auto& colours = colours_of(scale);
  Raster raster(image.width, image.height, kHoleColour);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (std::isnan(image.values[i])) continue;
    const double share = (static_cast<double>(image.values[i]) - range.low) / (range.high - range.low);
    raster.pixels[i] = colours[static_cast<std::size_t>(std::clamp(std::lround(share * 255.0), 0L, 255L))];
  }
  return raster;
}

}  // namespace fvd
