#include "daemon/export/texture_png.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

#include "daemon/export/export_input.hpp"
#include "daemon/export/png_bytes.hpp"

namespace fvd {

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

std::string texture_png_file(const ExportInput& input) { return encode_texture_png(input.map); }

}  // namespace fvd
