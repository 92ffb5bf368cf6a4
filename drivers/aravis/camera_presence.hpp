#pragma once

/// Whether the camera is there and ours. Inside the driver only: this header brings in Aravis.

#include <chrono>
#include <optional>
#include <string>

#include <arv.h>

#include "core/base/clock.hpp"
#include "drivers/aravis/control_watch.hpp"
#include "drivers/aravis/gvcp_probe.hpp"

namespace fvd {

/// Knows that a connection is lost from three sources: Aravis' heartbeat, a command that failed, and questions of its
/// own to a GigE Vision camera that is silent. A lost connection stays lost. Outlives the Aravis camera.
/// context: the thread that uses the camera; lost() and set_lost() any.
class CameraPresence {
 public:
  /// address: IP address, or vendor-model-serial.
  explicit CameraPresence(std::string address) : address_(std::move(address)) {}

  /// Asks for the camera before it is opened, because Aravis looks for an absent one for seconds. Throws Error
  /// kBadConfig for an empty address, kCameraDisconnected if it does not answer or another program controls it.
  void require_free() const;
  /// Called once, with the device that was opened. Throws Error kCameraDisconnected if another program controls it.
  void watch(ArvDevice* device);

  [[nodiscard]] ArvDevice* device() const { return control_.device(); }
  [[nodiscard]] bool lost() const noexcept { return control_.lost(); }
  void set_lost() noexcept { control_.set_lost(); }
  /// Throws Error kCameraDisconnected once the connection is lost.
  void require_connected() const;
  /// For commands that take too long: throws Error kCameraDisconnected if the camera does not answer either.
  void require_life();

  /// The question whether a silent camera is alive, asked while its frames are waited for.
  struct Question {
    bool open = false;
    HostTime asked{};
  };
  /// Asks, or looks for the answer to what was asked before. True if the camera is alive; false while there is no
  /// answer yet, and always if the camera answers its controller only. Throws Error kCameraDisconnected if it is lost.
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
