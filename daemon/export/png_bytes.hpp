#pragma once

/// A matrix as the bytes of a PNG file. Only sources of this folder include it: it includes OpenCV.

#include <string>

#include <opencv2/core.hpp>

namespace fvd {

/// image: 8 or 16 bit, 1 or 3 channels (BGR). Throws Error kInternal.
[[nodiscard]] std::string png_bytes(const cv::Mat& image);

}  // namespace fvd
