#pragma once

/// The daemon's devices: opened, watched, given up when they are lost, opened anew. A kind of device is one slot, one
/// opener and one row of the hub's table.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "core/base/units.hpp"
#include "core/hw/axis.hpp"
#include "core/hw/camera.hpp"
#include "daemon/devices/device_slot.hpp"
#include "daemon/devices/devices_health.hpp"
#include "drivers/registry/driver_table.hpp"

namespace fvd {

/// What is known of the open devices without asking them.
struct DeviceFacts {
  StageInfo stage;
  CameraInfo camera;
  bool simulated = false;
};

/// context: one thread, the machine's thread, except seen_standing().
class DeviceHub {
 public:
  /// on_rest: told whenever at_rest() changes, on the machine's thread.
  DeviceHub(DeviceOpeners openers, Clock& clock, std::function<void(bool at_rest)> on_rest);
  DeviceHub(const DeviceHub&) = delete;
  DeviceHub& operator=(const DeviceHub&) = delete;

  /// Opens every device that is missing, each once, and stops an axis that moves although nobody uses it. Why the
  /// devices cannot be used; nothing if they can. Never throws.
  [[nodiscard]] std::optional<DeviceFailure> open();

  /// The first device whose connection was lost since it was opened, else an axis of which standstill was to be
  /// measured and was not.
  [[nodiscard]] std::optional<DeviceFailure> failure();

  /// The alarm of the drive, as its newest sample says; it is not asked. Nothing without one, or without an axis.
  [[nodiscard]] std::optional<DeviceFailure> alarm() const;

  /// Measures that the axis stands still after a motion that was commanded; at_rest() and failure() tell. Drops
  /// nothing: whoever commanded the motion may still hold the axis.
  void confirm_rest();

  /// After a job or a command that ended by an error: gives up the device that the error says is lost or needs to be
  /// opened anew, and measures the axis' standstill. Opens nothing: the end is told first, open() comes later. Why the
  /// devices cannot be used; nothing if they can.
  [[nodiscard]] std::optional<DeviceFailure> after_failure(ErrorCode code, const std::string& message);

  /// Gives all devices up.
  void drop_all();

  /// open() returned nothing before.
  [[nodiscard]] Camera& camera() const { return camera_.get(); }
  [[nodiscard]] Axis& axis() const { return axis_.get(); }
  [[nodiscard]] DeviceFacts facts() const;
  /// What the devices count; nothing is asked of them.
  [[nodiscard]] DevicesHealth health() const;
  /// How often devices were opened so far.
  [[nodiscard]] int openings() const { return camera_.openings() + axis_.openings(); }

  /// The axis' standstill was measured since it was opened, and no motion was seen since.
  [[nodiscard]] bool at_rest() const { return at_rest_; }
  /// The axis is connected, and its newest sample, 200 ms old at most, says that it stands where standstill was
  /// measured last. An axis that nobody samples (replay) counts as standing. Asks nothing of the axis, waits for no
  /// device. context: any thread.
  [[nodiscard]] bool seen_standing() const;

 private:
  /// Where standstill was measured last, and how far from there the axis counts as being there.
  struct Rest {
    Micrometers place;
    Micrometers window;

    [[nodiscard]] bool holds(Micrometers position) const { return abs(position - place) <= window; }
  };
  struct Row {
    const char* kind;  ///< as messages name it
    AnyDeviceSlot& slot;
    std::vector<ErrorCode> renewed_after = {};                      ///< errors that only a new opening mends
    std::function<std::optional<DeviceFailure>()> check = nullptr;  ///< what must be so of an open device
  };

  [[nodiscard]] std::optional<DeviceFailure> check_axis();
  [[nodiscard]] std::optional<DeviceFailure> check_camera();
  [[nodiscard]] std::optional<DeviceFailure> lost();
  [[nodiscard]] bool moved_unasked() const;
  [[nodiscard]] std::optional<DeviceFailure> measure_standstill();
  [[nodiscard]] std::optional<DeviceFailure> standstill_or_drop();
  [[nodiscard]] Rest last_rest() const;
  void set_at_rest(bool at_rest);

  Clock& clock_;
  std::function<void(bool)> on_rest_;
  bool at_rest_ = false;
  mutable Mutex rest_mutex_;
  Rest rest_ FVD_GUARDED_BY(rest_mutex_);
  std::optional<DeviceFailure> restless_;  ///< why it was not, the last time
  int checked_opening_ = 0;                ///< of the axis, whose standstill was asked for
  DeviceSlot<Camera> camera_;
  DeviceSlot<Axis> axis_;
  std::vector<Row> rows_;  ///< in the order of opening
};

}  // namespace fvd
