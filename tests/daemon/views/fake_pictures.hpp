#pragma once

/// Pictures that a test shows.

#include <memory>

#include "daemon/export/preview_hub.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

class FakePictures final : public PictureSource {
 public:
  /// A picture of 64 x 32 pixels, bright at the upper left alone.
  void show(std::uint64_t seq) {
    auto picture = std::make_shared<PreviewPicture>();
    picture->seq = seq;
    picture->pixels = Plane<std::uint8_t>(64, 32, 40);
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 32; ++x) picture->pixels.at(x, y) = 200;
    }
    picture->image_width_px = 640;
    picture->image_height_px = 320;
    picture->z_um = 12.5;
    picture->focus = 8.25;
    picture->saturated_fraction = 0.125;
    newest = picture;
  }
  [[nodiscard]] std::shared_ptr<const PreviewPicture> newest_picture() override {
    ++looks;
    return newest;
  }
  std::shared_ptr<const PreviewPicture> newest;
  int looks = 0;
};

}  // namespace fvd
