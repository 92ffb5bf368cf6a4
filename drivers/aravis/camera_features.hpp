#pragma once

/// Writes settings to the camera's features in the order that cameras accept, checks each and reads it back. Inside the
/// driver only: this header includes Aravis.

#include <optional>
#include <string>

#include <arv.h>

#include "core/hw/camera.hpp"

namespace fvd {

/// Every function throws Error kCameraSettings, naming feature, value and what the camera accepts, or
/// kCameraDisconnected. context: the device's thread.
class CameraFeatures {
 public:
  /// where: for messages, e.g. the camera's address. The camera outlives this.
  CameraFeatures(ArvCamera* camera, std::string where) : camera_(camera), where_(std::move(where)) {}

  /// Applies the settings that can be changed only while nothing is acquired: format and region. Returns the settings
  /// in force.
  [[nodiscard]] CameraSettings apply_shape(const CameraSettings& settings) const;
  /// Applies exposure, gain, rate and trigger; the trigger last, because Aravis switches it off when it sets the rate.
  /// Updates in_force.
  void apply_timing(const CameraSettings& settings, CameraSettings& in_force) const;

  /// The largest size up to `room` that the increments of Width or Height allow, whatever its offset allows now.
  [[nodiscard]] int on_grid(const char* feature, gint64 room) const;
  /// Size of the sensor in pixels.
  void sensor_size(int& width, int& height) const;
  void set_integer(const char* feature, gint64 value) const;
  [[nodiscard]] gint64 integer(const char* feature) const;
  /// Increment of the values that the feature accepts, counted from its minimum.
  [[nodiscard]] gint64 increment(const char* feature) const;
  [[nodiscard]] bool available(const char* feature) const;

 private:
  void set_pixel_format(SensorFormat format) const;
  void set_region(const CameraSettings& settings, CameraSettings& in_force) const;
  [[nodiscard]] double set_exposure_us(double exposure_us) const;
  [[nodiscard]] double set_gain_db(double gain_db) const;
  [[nodiscard]] int set_gain_raw(const CameraSettings& settings) const;
  [[nodiscard]] int largest(const char* feature, gint64 room) const;
  [[nodiscard]] std::optional<std::string> text(const char* feature) const;
  void switch_chunks_off() const;
  [[nodiscard]] double set_frame_rate_hz(double frame_rate_hz) const;
  void set_trigger(const CameraSettings& settings) const;
  [[noreturn]] void refuse(const std::string& what) const;

  ArvCamera* camera_;
  std::string where_;
};

}  // namespace fvd
