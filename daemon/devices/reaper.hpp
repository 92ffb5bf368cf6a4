#pragma once

/// Closes devices on a thread of its own: closing a camera that no longer answers takes many seconds.

#include <atomic>
#include <deque>
#include <memory>
#include <stop_token>
#include <thread>

#include "core/base/mutex.hpp"

namespace fvd {

/// Becomes true when the device is closed; an empty pointer stands for no device.
using Closed = std::shared_ptr<const std::atomic<bool>>;

/// context: thread-safe. Destruction waits until every device that was handed over is closed, unless the process ends.
class Reaper {
 public:
  Reaper();
  ~Reaper();
  Reaper(const Reaper&) = delete;
  Reaper& operator=(const Reaper&) = delete;

  /// Destroys the device soon, on the reaper's thread. An empty pointer is allowed.
  template <typename Device>
  Closed bury(std::unique_ptr<Device> device) {
    return device ? enqueue(std::shared_ptr<void>(std::move(device))) : nullptr;
  }

  /// The process ends: from now on destruction waits a fifth of a second only. A device that answers nothing is then
  /// left to the system, which closes its sockets.
  static void process_ends() noexcept;
  /// A device was left; its thread still runs, so that the process must end by std::_Exit().
  [[nodiscard]] static bool left_a_device() noexcept;

 private:
  struct Burial {
    std::shared_ptr<void> device;
    std::shared_ptr<std::atomic<bool>> closed;
  };
  /// What the thread needs, which may outlive the reaper.
  struct Work {
    Mutex mutex;
    Condition changed;
    std::deque<Burial> given_up FVD_GUARDED_BY(mutex);
    bool ended FVD_GUARDED_BY(mutex) = false;
  };

  Closed enqueue(std::shared_ptr<void> device);
  static void run(Work& work, const std::stop_token& stop);

  std::shared_ptr<Work> work_ = std::make_shared<Work>();
  std::jthread thread_;
};

}  // namespace fvd
