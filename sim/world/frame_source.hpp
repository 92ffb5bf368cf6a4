#pragma once

/// The source of a simulated camera's pixels.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/clock.hpp"
#include "core/image/image.hpp"

namespace fvd::sim {

struct ExposureRequest {
  PixelFormat format = PixelFormat::kMono8;
  int offset_x = 0;  ///< region of the sensor, pixels
  int offset_y = 0;
  int width = 0;
  int height = 0;
  HostTime start{};  ///< exposure start and end on the host clock, both in the past
  HostTime end{};
  double gain_db = 0.0;
  std::uint64_t exposure_index = 0;  ///< number of the exposure since the camera started; seeds the noise
};

/// context: render() from the camera's thread only.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  [[nodiscard]] virtual int sensor_width() const = 0;
  [[nodiscard]] virtual int sensor_height() const = 0;
  /// Fills out with width * height pixels of the requested region, rows contiguous, 16-bit formats little-endian.
  virtual void render(const ExposureRequest& request, std::span<std::byte> out) = 0;
};

}  // namespace fvd::sim
