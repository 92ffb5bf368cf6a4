#pragma once

/// Whether the camera answers and this program controls it. Inside the driver only: this header includes Aravis.

#include <chrono>
#include <optional>
#include <string>

#include <arv.h>

#include "core/base/clock.hpp"
#include "drivers/aravis/control_watch.hpp"
#include "drivers/aravis/gvcp_probe.hpp"

namespace fvd {

/// Detects a lost connection from three sources: Aravis' heartbeat, a command that failed, and its own requests to a
/// GigE Vision camera that is silent. A lost connection stays lost. Outlives the Aravis camera. context: the thread
/// that uses the camera; lost() and set_lost() any.
class CameraPresence {
 public:
  /// address: IP address, or vendor-model-serial.
  explicit CameraPresence(std::string address) : address_(std::move(address)) {}

  /// Checks that the camera answers before it is opened, because Aravis searches for an absent one for seconds. Throws
  /// Error kBadConfig for an empty address, kCameraDisconnected if it does not answer or another program controls it.
  void require_free() const;
  /// Called once, with the device that was opened. Throws Error kCameraDisconnected if another program controls it.
  void watch(ArvDevice* device);

  [[nodiscard]] ArvDevice* device() const { return control_.device(); }
  [[nodiscard]] bool lost() const noexcept { return control_.lost(); }
  void set_lost() noexcept { control_.set_lost(); }
  /// Throws Error kCameraDisconnected once the connection is lost.
  void require_connected() const;
  /// To be called when a command takes too long: throws Error kCameraDisconnected if the camera does not answer a
  /// request either.
  void require_life();

  /// A pending request to a silent camera, used while waiting for its frames.
  struct Question {
    bool open = false;
    HostTime asked{};
  };
  /// Sends the request, or checks for the answer to the pending one. True if the camera is alive; false while there is
  /// no answer yet, and always if the camera answers its controller only. Throws Error kCameraDisconnected if it is
  /// lost.
  [[nodiscard]] bool answers(Question& question);

 private:
  void open_probe();
  void require_control() const;
  [[noreturn]] void throw_controlled() const;
  [[noreturn]] void lose(const char* why);
  bool judge(GvcpProbe::Answer answer);

  std::string address_;
  std::string loss_ = "its heartbeat failed; check power and cable";
  ControlWatch control_;
  std::optional<GvcpProbe> probe_;  // nothing: not GigE Vision, or it answers its controller only
};

}  // namespace fvd
