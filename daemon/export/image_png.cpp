#include "daemon/export/image_png.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

#include "daemon/export/png_bytes.hpp"

namespace fvd {

std::string encode_image_png(const ImageView& image) {
  const bool narrow = bytes_per_pixel(image.format) == 1;
  return png_bytes(cv::Mat(image.height, image.width, narrow ? CV_8U : CV_16U, const_cast<std::byte*>(image.data),
                           static_cast<std::size_t>(image.row_stride_bytes)));
}

std::string encode_mask_png(const HeightMap& map) {
  cv::Mat image(map.mask.height(), map.mask.width(), CV_8U);
  std::transform(map.mask.pixels().begin(), map.mask.pixels().end(), image.begin<std::uint8_t>(),
                 [](std::uint8_t mask) { return mask == 0 ? std::uint8_t{255} : mask; });
  return png_bytes(image);
}

std::string encode_texture_png(const HeightMap& map) {
  if (!map.colour.empty()) {
    const std::uint8_t* colours = map.colour.row(0);
    return png_bytes(cv::Mat(map.colour.height(), map.colour.width() / 3, CV_8UC3, const_cast<std::uint8_t*>(colours)));
  }
  const bool narrow = map.texture_format == PixelFormat::kMono8;
  cv::Mat image(map.texture.height(), map.texture.width(), narrow ? CV_8U : CV_16U);
  if (narrow) {
    std::transform(map.texture.pixels().begin(), map.texture.pixels().end(), image.begin<std::uint8_t>(),
                   [](std::uint16_t level) { return static_cast<std::uint8_t>(level); });
  } else {
    std::copy(map.texture.pixels().begin(), map.texture.pixels().end(), image.begin<std::uint16_t>());
  }
  return png_bytes(image);
}

}  // namespace fvd
