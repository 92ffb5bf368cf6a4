#pragma once

/// The settings in force, the stream of frames, and the camera's clock. Inside the driver only: this header brings in
/// Aravis.

#include <chrono>
#include <cstdint>
#include <optional>

#include <arv.h>

#include "core/hw/camera.hpp"
#include "drivers/aravis/camera_clock.hpp"
#include "drivers/aravis/camera_features.hpp"
#include "drivers/aravis/camera_presence.hpp"
#include "drivers/aravis/frame_buffers.hpp"
#include "drivers/aravis/frame_intake.hpp"
#include "drivers/aravis/gige_transport.hpp"
#include "drivers/common/driver_config.hpp"

namespace fvd {

/// Acquires from the first configure() on. The device's thread changes it; the thread that uses the camera reads it
/// when that command is done, renew_clock() excepted, which may run beside everything but clock_due().
class Acquisition {
 public:
  /// What the parameters refer to outlives the acquisition. clock_renewal: age at which what is known of the camera's
  /// clock is renewed.
  Acquisition(ArvCamera* camera, const CameraConfig& config, const CameraFeatures& features,
              const CameraPresence& presence, std::chrono::milliseconds clock_renewal);
  /// Stops the camera unless it is lost. context: the device's thread has ended.
  ~Acquisition();
  Acquisition(const Acquisition&) = delete;
  Acquisition& operator=(const Acquisition&) = delete;

  /// Puts the settings into force and knows the camera's clock afterwards. Only another format, region or pool rebuilds
  /// the stream. Throws Error kCameraSettings, kCameraDisconnected. context: the device's thread.
  void configure(const CameraSettings& settings);
  /// Throws Error kCameraSettings, kCameraDisconnected. context: the device's thread.
  void send_trigger();
  /// Latches the camera's clock if what is known of it is old. context: the device's thread.
  void renew_clock();

  /// Whether a latch is due. context: while no renew_clock() runs.
  [[nodiscard]] bool clock_due() const { return latches_ && clock_.due(HostClock::now()); }

  [[nodiscard]] const CameraSettings& in_force() const { return in_force_; }
  /// The next buffer, waiting at most that long; nullptr if there is none, or no stream yet.
  [[nodiscard]] ArvBuffer* pop(std::chrono::microseconds timeout);
  /// The frame of a buffer; nothing for one of the settings before.
  [[nodiscard]] std::optional<Frame> take(ArvBuffer* buffer);
  /// Follows a camera that began to count its frames anew: Aravis takes them for late ones and throws them away.
  void resynchronise();

  /// From the moment that starts or may start an exposure until its frame is there, if nothing goes wrong.
  [[nodiscard]] std::chrono::microseconds longest_frame_time() const;
  /// The same with the configured margin: then the frame counts as missing.
  [[nodiscard]] std::chrono::microseconds frame_deadline() const;
  [[nodiscard]] CameraHealth health() const;

 private:
  void change_to(const CameraSettings& settings);
  [[nodiscard]] bool change_timing(const CameraSettings& settings);
  void rebuild(const CameraSettings& settings);
  void start();
  void stop() noexcept;
  std::uint64_t warm_up();
  void take_clock_from_triggers();
  [[nodiscard]] std::chrono::microseconds readout() const;
  [[nodiscard]] StreamTimes stream_times() const;

  ArvCamera* const camera_;
  const CameraConfig& config_;
  const CameraFeatures& features_;
  const CameraPresence& presence_;
  CameraClock clock_;
  FrameIntake intake_{clock_};
  std::optional<CameraSettings> requested_;
  CameraSettings in_force_;
  std::optional<FrameBuffers> frames_;
  HostTime configured_{};
  std::uint64_t ignored_packets_ = 0;  // by Aravis, up to the last good frame
  bool latches_ = true;                // the camera supports timestamp latching; renew_clock() writes it
};

}  // namespace fvd
