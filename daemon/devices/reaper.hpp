#pragma once

/// Buries devices on a thread of its own: closing a camera that no longer answers takes many seconds.

#include <deque>
#include <memory>
#include <stop_token>
#include <thread>

#include "core/base/mutex.hpp"

namespace fvd {

/// context: thread-safe. Destruction waits until everything handed over is gone.
class Reaper {
 public:
  Reaper();
  ~Reaper();

  /// Destroys the device soon, on the reaper's thread.
  template <typename Device>
  void bury(std::unique_ptr<Device> device) {
    if (device) enqueue(std::shared_ptr<void>(std::move(device)));
  }

 private:
  void enqueue(std::shared_ptr<void> device);
  void run(std::stop_token stop);

  Mutex mutex_;
  Condition changed_;
  std::deque<std::shared_ptr<void>> dead_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd
