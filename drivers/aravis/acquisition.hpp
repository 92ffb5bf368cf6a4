#pragma once

/// The settings in force, the stream of frames, and the camera's clock. Inside the driver only: this header brings in
/// Aravis.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

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

/// Acquires from the first configure() on. The device's thread changes the object; the thread that uses the camera
/// reads it after that command has ended. Only renew_clock() and renew_clock_early() may run at the same time as other
/// functions. A configure() whose caller was interrupted may still run: only clock_due() and clock_due_soon() may be
/// called meanwhile.
class Acquisition {
 public:
  /// The referenced objects outlive the acquisition. clock_renewal: age at which the offset of the camera's clock is
  /// measured again.
  Acquisition(ArvCamera* camera, const CameraConfig& config, const CameraFeatures& features,
              const CameraPresence& presence, std::chrono::milliseconds clock_renewal);
  /// Stops the camera unless it is lost. context: the device's thread has ended.
  ~Acquisition();
  Acquisition(const Acquisition&) = delete;
  Acquisition& operator=(const Acquisition&) = delete;

  /// Puts the settings into force and measures the camera's clock. Only another format, region or pool rebuilds the
  /// stream. Throws Error kCameraSettings, kCameraDisconnected. context: the device's thread.
  void configure(const CameraSettings& settings);
  /// Throws Error kCameraSettings, kCameraDisconnected. context: the device's thread.
  void send_trigger();
  /// Latches the camera's clock if a latch is due. context: the device's thread.
  void renew_clock();
  /// The same if one soon will be: while nothing is asked of the camera, so that no scan waits for it. context: the
  /// device's thread.
  void renew_clock_early();

  /// Whether a latch is due; while one is being made the answer is of before. context: thread-safe.
  [[nodiscard]] bool clock_due() const { return latches_ && clock_.due(HostClock::now()); }
  [[nodiscard]] bool clock_due_soon() const { return latches_ && clock_.due_soon(HostClock::now()); }
  /// The time of a frame cannot be right: the next clock_due() says so.
  void doubt_clock() { clock_.doubt(); }
  [[nodiscard]] const std::string& refusal() const { return intake_.refusal(); }

  [[nodiscard]] const CameraSettings& in_force() const { return in_force_; }
  /// The next buffer; waits at most `timeout`; nullptr if none came, or there is no stream yet.
  [[nodiscard]] ArvBuffer* pop(std::chrono::microseconds timeout);
  /// The frame of a buffer; nothing for a buffer of the previous settings, or for one whose time is older than they
  /// are.
  [[nodiscard]] std::optional<Frame> take(ArvBuffer* buffer);
  /// To be called when a camera has restarted its block ids: Aravis would discard its frames as late ones.
  void resynchronise();

  /// Longest time from the event that starts an exposure to the arrival of its frame, without faults.
  [[nodiscard]] std::chrono::microseconds longest_frame_time() const;
  /// longest_frame_time() plus the configured margin; after it the frame counts as missing.
  [[nodiscard]] std::chrono::microseconds frame_deadline() const;
  [[nodiscard]] CameraHealth health() const;

 private:
  void change_to(const CameraSettings& settings);
  [[nodiscard]] bool change_timing(const CameraSettings& settings);
  void rebuild(const CameraSettings& settings);
  void start();
  void stop() noexcept;
  std::uint64_t warm_up();
  void latch();
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
  std::atomic<bool> latches_{true};    // the camera supports timestamp latching; latch() writes it
};

}  // namespace fvd
