#pragma once

/// The camera as the scan needs it: software-triggered frames from a fixed pool.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/frame.hpp"
#include "core/image.hpp"

namespace fvd {

/// What the recipe asks of the camera. SFNC names in the comments.
struct CameraSettings {
  PixelFormat pixel_format = PixelFormat::kMono8;  ///< PixelFormat
  int width = 0;                                   ///< Width in pixels, 0 = all the sensor has
  int height = 0;                                  ///< Height in pixels, 0 = all the sensor has
  int offset_x = 0;                                ///< OffsetX in pixels
  int offset_y = 0;                                ///< OffsetY in pixels
  double exposure_us = 5000.0;                     ///< ExposureTime, > 0
  double gain_db = 0.0;                            ///< Gain
  int pool_frames = 8;                             ///< slots of the frame pool, >= 3

  bool operator==(const CameraSettings&) const = default;
};

struct CameraInfo {
  std::string vendor;
  std::string model;
  std::string serial;
  std::string address;
  int sensor_width = 0;  ///< pixels, what a region of 0 x 0 means
  int sensor_height = 0;
  bool simulated = false;
};

/// Counters since the camera was opened.
struct CameraHealth {
  std::uint64_t frames_complete = 0;
  std::uint64_t frames_failed = 0;
  std::uint64_t underruns = 0;
  std::uint64_t packets_resent = 0;
  std::uint64_t packets_missing = 0;
};

/// An open camera. Constructing one opens it (throws Error kCameraDisconnected), destroying it closes it; destruction
/// of a camera that no longer answers may take seconds. Frames must be gone before their camera is, or is configured
/// anew.
/// context: one thread at a time, except interrupt() and connected().
class Camera {
 public:
  virtual ~Camera() = default;

  [[nodiscard]] virtual CameraInfo info() const = 0;

  /// Applies and reads back every setting, (re)builds the pool and starts acquisition in trigger mode; cheap when the
  /// settings have not changed. Returns what is in force. Throws Error kCameraSettings, kCameraDisconnected.
  virtual CameraSettings configure(const CameraSettings& settings) = 0;

  /// Starts one exposure. Throws Error kCameraDisconnected; may block as long as the camera's command timeout.
  virtual void trigger() = 0;

  /// The next frame in order of arrival, good or bad, or nothing by `deadline` or after interrupt(). A deadline in the
  /// past only looks. Throws Error kCameraDisconnected once the connection is known to be gone.
  [[nodiscard]] virtual std::optional<Frame> next_frame(HostTime deadline) = 0;

  /// Longest time from trigger() to the arrival of its frame with the settings in force.
  [[nodiscard]] virtual std::chrono::microseconds frame_deadline() const = 0;

  /// Ends a next_frame() that is waiting, now or the next time it is called. context: any thread.
  virtual void interrupt() noexcept = 0;

  [[nodiscard]] virtual bool connected() const noexcept = 0;
  [[nodiscard]] virtual CameraHealth health() const = 0;
};

}  // namespace fvd
