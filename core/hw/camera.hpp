#pragma once

/// The camera as the scan needs it: frames from a fixed pool, triggered or free-running.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "core/image/frame.hpp"
#include "core/image/image.hpp"
#include "core/image/sensor_format.hpp"

namespace fvd {

/// What starts an exposure.
enum class TriggerMode {
  kSoftware,  ///< trigger(): TriggerMode On, TriggerSource Software
  kLine,      ///< an edge on trigger_line, e.g. from the drive's in-position output: TriggerMode On
  kFreeRun,   ///< the end of the one before, at frame_rate_hz: TriggerMode Off
};

/// What the recipe asks of the camera. SFNC names in the comments.
struct CameraSettings {
  SensorFormat pixel_format = SensorFormat::kMono8;  ///< PixelFormat
  int significant_bits = 0;  ///< 10 or 12 for a 16-bit format whose values fill the upper bits; 0 = as its name says
  BayerUse bayer = BayerUse::kGreen;  ///< which values of a colour mosaic are measured
  int width = 0;                      ///< Width in pixels, 0 = the sensor's
  int height = 0;                     ///< Height in pixels, 0 = the sensor's
  int offset_x = 0;                   ///< OffsetX in pixels
  int offset_y = 0;                   ///< OffsetY in pixels
  double exposure_us = 5000.0;        ///< ExposureTime, > 0
  double gain_db = 0.0;               ///< Gain
  TriggerMode trigger = TriggerMode::kSoftware;
  std::string trigger_line = "Line0";  ///< kLine: TriggerSource
  double frame_rate_hz = 0.0;          ///< kFreeRun: AcquisitionFrameRate, 0 = as fast as the camera can
  /// GainRaw, in a unit of the camera's own, of cameras that have no Gain in dB; -1 = the least.
  int gain_raw = -1;
  int pool_frames = 11;  ///< slots of the frame pool, >= 3; a scan holds three frames back to judge them

  /// Pixel format of the slices that these settings give.
  [[nodiscard]] PixelFormat slice_format() const { return fvd::slice_format(pixel_format, significant_bits); }

  bool operator==(const CameraSettings&) const = default;
};

struct CameraInfo {
  std::string vendor;
  std::string model;
  std::string serial;
  std::string firmware;  ///< DeviceVersion, empty if the camera does not tell
  std::string address;   ///< IP address; of a camera without one, what it was opened by
  int sensor_width = 0;  ///< pixels; the width that CameraSettings::width 0 stands for
  int sensor_height = 0;
  bool simulated = false;
};

/// "vendor model serial, firmware 1.0, at 192.168.1.20": for logs and results.
[[nodiscard]] inline std::string camera_text(const CameraInfo& camera) {
  const std::string firmware = camera.firmware.empty() ? "" : ", firmware " + camera.firmware + ",";
  return camera.vendor + " " + camera.model + " " + camera.serial + firmware + " at " + camera.address;
}

/// Counters since the camera was opened.
struct CameraHealth {
  std::uint64_t frames_complete = 0;
  std::uint64_t frames_failed = 0;  ///< delivered, but incomplete or of the wrong geometry
  std::uint64_t underruns = 0;      ///< frames lost because no slot of the pool was free
  std::uint64_t packets_resent = 0;
  std::uint64_t packets_missing = 0;
  std::uint64_t ids_skipped = 0;  ///< frame ids that were skipped: frames that the camera took and did not deliver
};

/// An open camera. Constructing one opens it (throws Error kCameraDisconnected), destroying it closes it; destruction
/// of a camera that no longer answers may take seconds. Frames must be gone before their camera is, or is configured
/// anew.
/// context: one thread at a time, except interrupt() and connected().
class Camera {
 public:
  virtual ~Camera() = default;

  [[nodiscard]] virtual CameraInfo info() const = 0;

  /// Applies and reads back every setting, (re)builds the pool where its shape changed, and acquires from then on:
  /// triggered, or at once if free-running. Frames of the previous settings are gone when it returns. Cheap when the
  /// settings have not changed. Returns the settings in force. Throws Error kCameraSettings, kCameraDisconnected.
  virtual CameraSettings configure(const CameraSettings& settings) = 0;

  /// Starts one exposure; only with TriggerMode::kSoftware. Throws Error kCameraDisconnected. Blocks half a second at
  /// most, longer only while a driver repeats the command before and the camera answers otherwise; not after
  /// interrupt(), which may leave the exposure undone.
  virtual void trigger() = 0;

  /// The next frame in order of arrival, good or bad; nothing if none came by `deadline`, or after interrupt(). Does
  /// not wait if the deadline is in the past. Throws Error kCameraDisconnected once the connection is known to be gone.
  [[nodiscard]] virtual std::optional<Frame> next_frame(HostTime deadline) = 0;

  /// Longest time from the start of an exposure to the arrival of its frame with the settings in force.
  [[nodiscard]] virtual std::chrono::microseconds frame_deadline() const = 0;

  /// Ends the wait of next_frame(), now or at its next call, that of trigger(), and that of configure(), which then
  /// throws Error kAborted; a configure() that begins later cancels the request. context: any thread.
  virtual void interrupt() noexcept = 0;

  /// Why the last frame whose status was kWrongGeometry or kMisdated was refused: what came and what was expected.
  /// Empty if there was none since configure().
  [[nodiscard]] virtual std::string last_refusal() const { return {}; }

  /// To be called every half second or so while nothing else is asked of the camera: notices that it is gone;
  /// connected() tells; keeps the camera's clock known. Blocks a tenth of a second at most.
  virtual void look_after() {}

  [[nodiscard]] virtual bool connected() const noexcept = 0;
  [[nodiscard]] virtual CameraHealth health() const = 0;
};

}  // namespace fvd
