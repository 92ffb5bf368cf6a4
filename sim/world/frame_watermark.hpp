#pragma once

/// A mark in the pixels of a frame that identifies its exposure, so that a test can prove which frame it got.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/image/image.hpp"
#include "sim/world/frame_source.hpp"

namespace fvd::sim {

struct Watermark {
  std::uint64_t exposure_index = 0;
  double z_um = 0.0;  ///< true position at the middle of the exposure, to a nanometre
};

/// Nothing if the checksum over all other pixels or the mark itself is wrong. Images have at least 24 pixels per row.
[[nodiscard]] std::optional<Watermark> read_watermark(const ImageView& image);

/// Marks the images of another source: the first 20 pixels of row 0 hold index, z in nm, and the CRC-32 of both and of
/// all later pixels, one byte per pixel, in the lower 8 bits of wider pixels. Frames in packed formats or mosaics lose
/// their mark on the wire. context: as its source.
class WatermarkedSource final : public FrameSource {
 public:
  /// z_um: returns the true position at a time, which may lie in the past. source outlives this object.
  WatermarkedSource(FrameSource& source, std::function<double(HostTime)> z_um)
      : source_(source), z_um_(std::move(z_um)) {}

  [[nodiscard]] int sensor_width() const override { return source_.sensor_width(); }
  [[nodiscard]] int sensor_height() const override { return source_.sensor_height(); }
  void render(const ExposureRequest& request, std::span<std::byte> out) override;

 private:
  FrameSource& source_;
  std::function<double(HostTime)> z_um_;
};

}  // namespace fvd::sim
