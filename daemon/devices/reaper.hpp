#pragma once

/// Closes devices on a thread of its own: closing a camera that no longer answers takes many seconds.

#include <atomic>
#include <chrono>
#include <deque>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

#include "core/base/mutex.hpp"

namespace fvd {

/// Becomes true when the device is closed; an empty pointer stands for no device.
using Closed = std::shared_ptr<const std::atomic<bool>>;

/// context: thread-safe. Destruction waits until every device that was handed over is closed; when the process ends
/// (left_threads.hpp), for `last_wait` at most.
class Reaper {
 public:
  /// name: of its thread, at most 15 bytes; by it the watchdog tells whose device hangs.
  explicit Reaper(std::string name, std::chrono::milliseconds last_wait = std::chrono::milliseconds(200));
  ~Reaper();
  Reaper(const Reaper&) = delete;
  Reaper& operator=(const Reaper&) = delete;

  /// Destroys the device soon, on the reaper's thread. An empty pointer is allowed.
  template <typename Device>
  Closed bury(std::unique_ptr<Device> device) {
    return device ? enqueue(std::shared_ptr<void>(std::move(device))) : nullptr;
  }

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
  static void run(const std::string& name, Work& work, const std::stop_token& stop);

  const std::chrono::milliseconds last_wait_;
  std::shared_ptr<Work> work_ = std::make_shared<Work>();
  std::jthread thread_;
};

}  // namespace fvd
