#include "daemon/export/mask_png.hpp"

#include <opencv2/core.hpp>

#include "daemon/export/export_input.hpp"
#include "daemon/export/png_bytes.hpp"

namespace fvd {

std::string encode_mask_png(const HeightMap& map) {
  static_assert(sizeof(MaskReasons) == 2);
  return png_bytes(cv::Mat(map.mask.height(), map.mask.width(), CV_16U, const_cast<MaskReasons*>(map.mask.row(0))));
}

std::string mask_png_file(const ExportInput& input) { return encode_mask_png(input.map); }

}  // namespace fvd
