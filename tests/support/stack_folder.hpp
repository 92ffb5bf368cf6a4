#pragma once

/// Writes small recorded stacks for tests.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace fvd::test {

/// A reproducible pattern: sharp (contrast 1) where the slice is in focus at height `focus`, flatter away from it.
/// type: CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3.
inline cv::Mat pattern_slice(double z, double focus, int type = CV_8UC1, int width = 40, int height = 30) {
  const double full = CV_MAT_DEPTH(type) == CV_8U ? 255.0 : 65535.0;
  const double contrast = std::exp(-(z - focus) * (z - focus) / 8.0);
  cv::Mat slice(height, width, type);
  std::uint32_t state = 12345;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      state = state * 1664525U + 1013904223U;  // Numerical Recipes LCG
      const double texture = static_cast<double>(state >> 16U) / 65536.0 - 0.5;
      const double level = full * (0.5 + 0.8 * contrast * texture);
      for (int channel = 0; channel < slice.channels(); ++channel) {
        if (slice.depth() == CV_8U) {
          slice.ptr<std::uint8_t>(y)[x * slice.channels() + channel] = static_cast<std::uint8_t>(level);
        } else {
          slice.ptr<std::uint16_t>(y)[x * slice.channels() + channel] = static_cast<std::uint16_t>(level);
        }
      }
    }
  }
  return slice;
}

/// count slices at z = 0, 1, 2 ...: prefix0ext, prefix1ext ... without leading zeros.
inline void write_stack(const std::filesystem::path& folder, const std::string& prefix, const std::string& extension,
                        int count, double focus, int type = CV_8UC1) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < count; ++i) {
    cv::imwrite((folder / (prefix + std::to_string(i) + extension)).string(), pattern_slice(i, focus, type));
  }
}

/// All slices as pages of one TIFF.
inline void write_pages(const std::filesystem::path& file, int count, double focus) {
  std::vector<cv::Mat> pages;
  for (int i = 0; i < count; ++i) pages.push_back(pattern_slice(i, focus));
  cv::imwritemulti(file.string(), pages);
}

/// A map of floating point numbers; empty where there is none.
inline cv::Mat read_float(const std::filesystem::path& path) { return cv::imread(path.string(), cv::IMREAD_UNCHANGED); }

}  // namespace fvd::test
