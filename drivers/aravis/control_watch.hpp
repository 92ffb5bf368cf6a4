#pragma once

/// Holds an Aravis device and detects the loss of control of it.

#include <atomic>
#include <memory>

#include <arv.h>

#include "drivers/aravis/gobject.hpp"

namespace fvd {

/// Outlives whatever else refers to the device: the last reference must not be dropped by the heartbeat's thread, which
/// holds one while it emits control-lost. That thread would destroy the device, join itself, and GLib would end the
/// process.
class ControlWatch {
 public:
  ControlWatch() = default;
  /// Waits, 5 s at most, until nothing else holds a reference to the device.
  ~ControlWatch();
  ControlWatch(const ControlWatch&) = delete;
  ControlWatch& operator=(const ControlWatch&) = delete;

  /// Called once.
  void watch(ArvDevice* device);

  [[nodiscard]] ArvDevice* device() const { return device_.get(); }
  [[nodiscard]] bool lost() const noexcept { return *lost_; }
  void set_lost() noexcept { *lost_ = true; }

 private:
  using Flag = std::shared_ptr<std::atomic<bool>>;

  static void on_control_lost(ArvDevice* device, gpointer flag);

  GObjectPtr<ArvDevice> device_;
  gulong handler_ = 0;
  Flag lost_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace fvd
