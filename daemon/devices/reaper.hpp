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

/// context: thread-safe. Destruction waits until every device that was handed over is closed.
class Reaper {
 public:
  Reaper();
  ~Reaper();

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

  Closed enqueue(std::shared_ptr<void> device);
  void run(std::stop_token stop);

  Mutex mutex_;
  Condition changed_;
  std::deque<Burial> given_up_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last: ends before anything it uses
};

}  // namespace fvd
