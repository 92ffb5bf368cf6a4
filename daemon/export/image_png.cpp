#include "daemon/export/image_png.hpp"

#include <opencv2/core.hpp>

#include "daemon/export/png_bytes.hpp"

namespace fvd {

std::string encode_image_png(const ImageView& image) {
  const bool narrow = bytes_per_pixel(image.format) == 1;
  return png_bytes(cv::Mat(image.height, image.width, narrow ? CV_8U : CV_16U, const_cast<std::byte*>(image.data),
                           static_cast<std::size_t>(image.row_stride_bytes)));
}

}  // namespace fvd
