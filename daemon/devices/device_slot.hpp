#pragma once

/// Keeps one device open: opens it, notices its loss, opens it again.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "daemon/devices/reaper.hpp"

namespace fvd {

struct DeviceFailure {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;

  bool operator==(const DeviceFailure&) const = default;
};

/// Device has connected(); destroying it may block, so dead ones go to the reaper.
/// context: the engine's thread.
template <typename Device>
class DeviceSlot {
 public:
  using Opener = std::function<std::unique_ptr<Device>()>;

  /// lost: the code that stands for a device that was open and is gone.
  DeviceSlot(Opener opener, ErrorCode lost, Reaper& reaper)
      : opener_(std::move(opener)), lost_(lost), reaper_(reaper) {}
  ~DeviceSlot() { drop(); }
  DeviceSlot(const DeviceSlot&) = delete;
  DeviceSlot& operator=(const DeviceSlot&) = delete;

  /// True when the device is open and connected; tries to open it if it is not. Never throws.
  bool ensure() {
    if (device_ && !device_->connected()) {
      drop();
      failure_ = DeviceFailure{lost_, "the connection was lost"};
    }
    if (device_) return true;
    try {
      device_ = opener_();
      failure_.reset();
      ++openings_;
      return true;
    } catch (const Error& error) {
      failure_ = DeviceFailure{error.code(), error.what()};
    } catch (const std::exception& error) {
      failure_ = DeviceFailure{ErrorCode::kInternal, error.what()};
    }
    return false;
  }

  /// Gives the device up; ensure() will open it anew.
  void drop() { reaper_.bury(std::move(device_)); }

  /// The device; ensure() returned true before.
  [[nodiscard]] Device& get() const { return *device_; }
  [[nodiscard]] bool connected() const { return device_ && device_->connected(); }
  /// How often a device was opened so far.
  [[nodiscard]] int openings() const { return openings_; }
  [[nodiscard]] const std::optional<DeviceFailure>& failure() const { return failure_; }

 private:
  Opener opener_;
  ErrorCode lost_;
  Reaper& reaper_;
  std::unique_ptr<Device> device_;
  int openings_ = 0;
  std::optional<DeviceFailure> failure_;
};

}  // namespace fvd
