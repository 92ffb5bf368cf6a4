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
  /// name: as messages call the camera. silence: a camera that answers nothing for so long is lost.
  CameraPresence(std::string name, std::chrono::milliseconds silence) : name_(std::move(name)), silence_(silence) {}
  ~CameraPresence();
  CameraPresence(const CameraPresence&) = delete;
  CameraPresence& operator=(const CameraPresence&) = delete;

  /// Checks that a GigE Vision camera answers before it is opened, because Aravis searches for an absent one for
  /// seconds. Throws Error kCameraDisconnected if it does not answer, or denies control to this program.
  void require_free(const std::string& ip) const;
  /// Called once, with the device that was opened. Throws Error kCameraDisconnected if the camera denies control.
  void watch(ArvDevice* device);

  [[nodiscard]] ArvDevice* device() const { return control_.device(); }
  [[nodiscard]] bool lost() const noexcept { return control_.lost(); }
  void set_lost() noexcept { control_.set_lost(); }
  /// Throws Error kCameraDisconnected once the connection is lost.
  void require_connected() const;

  /// To be called again and again while the camera owes something: sends a request, or looks for the answer to the one
  /// before, without waiting. True if the camera is alive; false while there is no answer yet, and always if the camera
  /// answers its controller only. Throws Error kCameraDisconnected if it is lost.
  [[nodiscard]] bool alive();
  /// A request is open: its answer decides whether the camera is lost.
  [[nodiscard]] bool asking() const { return asked_.has_value(); }
  /// Something came from the camera: the open request is settled.
  void heard() noexcept { asked_.reset(); }
  /// alive(), but waits for the answer, a tenth of a second at most.
  void look_after();

 private:
  void open_probe(const std::string& ip);
  void take_control(const std::string& ip) const;
  [[noreturn]] void throw_controlled(const std::string& ip) const;
  [[noreturn]] void lose(const char* why);

  const std::string name_;
  const std::chrono::milliseconds silence_;
  std::string loss_ = "its heartbeat failed; check power and cable";
  std::string held_;  // the camera this program controls, by its IP address
  ControlWatch control_;
  std::optional<GvcpProbe> probe_;  // nothing: not GigE Vision, or it answers its controller only
  std::optional<HostTime> asked_;
  HostTime looked_{};  // for the answer, last
};

}  // namespace fvd
