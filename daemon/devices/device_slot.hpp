#pragma once

/// Keeps one device open: opens it, notices its loss, opens it again.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "daemon/devices/left_threads.hpp"
#include "daemon/devices/reaper.hpp"

namespace fvd {

struct DeviceFailure {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;

  bool operator==(const DeviceFailure&) const = default;
};

/// A slot of whatever kind of device.
/// context: the machine's thread.
class AnyDeviceSlot {
 public:
  virtual ~AnyDeviceSlot() = default;
  /// True when the device is open and connected; tries to open it if it is not. Never throws.
  [[nodiscard]] virtual bool ensure() = 0;
  /// Gives the device up; ensure() will open it anew.
  virtual void drop() = 0;
  [[nodiscard]] virtual bool connected() const = 0;
  /// Why ensure() returned false; nothing after it returned true.
  [[nodiscard]] virtual const std::optional<DeviceFailure>& failure() const = 0;
  /// The code that stands for a device that was open and is gone.
  [[nodiscard]] virtual ErrorCode lost() const = 0;
};

/// What a slot does about a device that was given up and is not closed yet.
enum class Predecessor {
  kIgnored,  ///< opens the next one beside it: its closing may take long and does the next one no harm
  kAwaited,  ///< opens no other before: what it sends while it is closed would reach the next one
};

/// How long the end of the process waits for a device's closing: a camera's may take many seconds and is left, a
/// drive's sends what counts - a stop, a watchdog's disarming - and its answers are due within some tenths of a second.
[[nodiscard]] constexpr std::chrono::milliseconds last_wait(Predecessor predecessor) {
  return std::chrono::milliseconds(predecessor == Predecessor::kAwaited ? 1000 : 200);
}

/// Device has connected(); destroying it may block, so a device that is given up goes to a reaper, the slot's own: no
/// slot waits for the device of another.
template <typename Device>
class DeviceSlot final : public AnyDeviceSlot {
 public:
  /// Returns an open device, or throws. Runs on a thread of its own and owns all that it uses: the process may end
  /// before it is done.
  using Opener = std::function<std::unique_ptr<Device>()>;

  /// closer: name of the thread that closes what was given up, as Reaper has it; each slot has another.
  DeviceSlot(Opener opener, ErrorCode lost, Predecessor predecessor, std::string closer)
      : opener_(std::move(opener)),
        lost_(lost),
        predecessor_(predecessor),
        reaper_(std::move(closer), last_wait(predecessor)) {}
  ~DeviceSlot() override { drop(); }
  DeviceSlot(const DeviceSlot&) = delete;
  DeviceSlot& operator=(const DeviceSlot&) = delete;

  bool ensure() override {
    if (device_ && !device_->connected()) drop();
    if (device_) return true;
    if (predecessor_ == Predecessor::kAwaited && closed_ && !*closed_) {
      failure_ = DeviceFailure{lost_, "the connection that was given up is still being closed; it is opened anew then"};
      return false;
    }
    try {
      const auto opened = std::make_shared<std::unique_ptr<Device>>();
      if (!run_unless_process_ends("fvd-opening", [opener = opener_, opened] { *opened = opener(); })) {
        failure_ = DeviceFailure{lost_, "the program ends while the device is being opened"};
        return false;
      }
      device_ = std::move(*opened);
      show(device_.get());
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
  void drop() override {
    show(nullptr);
    if (device_) closed_ = reaper_.bury(std::move(device_));
  }
  [[nodiscard]] bool connected() const override { return device_ && device_->connected(); }
  [[nodiscard]] const std::optional<DeviceFailure>& failure() const override { return failure_; }
  [[nodiscard]] ErrorCode lost() const override { return lost_; }

  /// The device; ensure() returned true before.
  [[nodiscard]] Device& get() const { return *device_; }
  /// What a question tells of the open device; nothing where none is open. The question is quick and takes no more of
  /// the device than any thread may, for giving it up waits for that. context: any thread.
  template <typename Question>
  [[nodiscard]] auto seen(Question question) const -> std::optional<decltype(question(std::declval<const Device&>()))> {
    const MutexLock lock(shown_mutex_);
    if (shown_ == nullptr) return std::nullopt;
    return question(*shown_);
  }
  /// How often a device was opened so far.
  [[nodiscard]] int openings() const { return openings_; }

 private:
  void show(const Device* device) {
    const MutexLock lock(shown_mutex_);
    shown_ = device;
  }

  Opener opener_;
  ErrorCode lost_;
  Predecessor predecessor_;
  Closed closed_;  // of the device that was given up last
  std::unique_ptr<Device> device_;
  mutable Mutex shown_mutex_;
  // device_ for other threads; null before it is given up.
  const Device* shown_ FVD_GUARDED_BY(shown_mutex_) = nullptr;
  int openings_ = 0;
  std::optional<DeviceFailure> failure_;
  Reaper reaper_;  // last: it is done with every device before the rest goes
};

}  // namespace fvd
