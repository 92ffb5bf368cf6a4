#pragma once

/// Images that cost no rendering time: four random images in turn.

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

#include "sim/world/frame_source.hpp"

namespace fvd::sim {

/// context: as a FrameSource.
class PatternSource final : public FrameSource {
 public:
  /// Sides in pixels, > 0.
  PatternSource(int width, int height) : width_(width), height_(height) {
    std::mt19937_64 random(1);
    for (auto& image : images_) {
      image.resize(2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 8);
      for (std::size_t i = 0; i + 8 <= image.size(); i += 8) {
        const std::uint64_t value = random();
        std::memcpy(&image[i], &value, 8);
      }
    }
  }

  [[nodiscard]] int sensor_width() const override { return width_; }
  [[nodiscard]] int sensor_height() const override { return height_; }
  void render(const ExposureRequest& request, std::span<std::byte> out) override {
    const auto& image = images_[request.exposure_index % images_.size()];
    std::copy_n(image.begin(), out.size(), out.begin());
    const auto top = static_cast<std::uint16_t>(max_grey_level(request.format));
    if (request.format == PixelFormat::kMono8 || top == 0xFFFF) return;
    for (std::size_t i = 1; i < out.size(); i += 2) out[i] &= static_cast<std::byte>(top >> 8U);
  }

 private:
  int width_;
  int height_;
  std::array<std::vector<std::byte>, 4> images_;
};

}  // namespace fvd::sim
