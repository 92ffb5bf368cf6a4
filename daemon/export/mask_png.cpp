#include "daemon/export/mask_png.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

#include "daemon/export/export_input.hpp"
#include "daemon/export/png_bytes.hpp"

namespace fvd {

std::string encode_mask_png(const HeightMap& map) {
  cv::Mat image(map.mask.height(), map.mask.width(), CV_8U);
  std::transform(map.mask.pixels().begin(), map.mask.pixels().end(), image.begin<std::uint8_t>(),
                 [](std::uint8_t mask) { return mask == 0 ? std::uint8_t{255} : mask; });
  return png_bytes(image);
}

std::string mask_png_file(const ExportInput& input) { return encode_mask_png(input.map); }

}  // namespace fvd
