#include "sim/world/contrast_map.hpp"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>

#include "core/base/error.hpp"
#include "sim/world/pixel_grid.hpp"

namespace fvd::sim {

namespace {

void take_picture(const std::filesystem::path& file, Plane<float>& share) {
  cv::Mat picture;
  try {
    picture = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    picture = cv::Mat();  // as one that is missing
  }
  if (picture.empty()) throw Error(ErrorCode::kBadInput, file.string() + " is missing or no image");
  if (picture.type() != CV_8UC1 || picture.cols != share.width() || picture.rows != share.height()) {
    throw Error(ErrorCode::kBadInput, file.string() + " is " + std::to_string(picture.cols) + " x " +
                                          std::to_string(picture.rows) + " pixels of " +
                                          std::to_string(picture.channels()) + " channels; expected grey of 8 bits, " +
                                          std::to_string(share.width()) + " x " + std::to_string(share.height()));
  }
  for (int y = 0; y < picture.rows; ++y) {
    std::transform(picture.ptr<std::uint8_t>(y), picture.ptr<std::uint8_t>(y) + picture.cols, share.row(y),
                   [](std::uint8_t level) { return static_cast<float>(level) / 255.0F; });
  }
}

bool inside(const ContrastRegion& region, const Directed& direction, const Place& place) {
  const double along = direction.along(place);
  const double across = direction.across(place);
  return along >= region.along_from_um && along < region.along_to_um && across >= region.across_from_um &&
         across < region.across_to_um;
}

}  // namespace

Plane<float> make_contrast(const WorldParameters& world, int width, int height) {
  Plane<float> share(width, height, 1.0F);
  const ContrastMap& contrast = world.artefacts.contrast;
  if (!contrast.picture_file.empty()) take_picture(contrast.picture_file, share);
  const PixelGrid grid{width, height, world.pixel_pitch_um};
  for (const ContrastRegion& region : contrast.regions) {
    const Directed direction(region.direction_deg);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (inside(region, direction, grid.centre(x, y))) {
          share.at(x, y) = static_cast<float>(region.contrast_percent / 100.0);
        }
      }
    }
  }
  return share;
}

}  // namespace fvd::sim
