#pragma once

/// Closes devices on a thread of its own: closing a camera that no longer answers takes many seconds.

#include <deque>
#include <memory>
#include <stop_token>
#include <thread>

#include "core/base/mutex.hpp"

namespace fvd {

/// context: thread-safe. Destruction waits until every device that was handed over is closed.
class Reaper {
 public:
  Reaper();
  ~Reaper();

  /// Destroys the device soon, on the reaper's thread. An empty pointer is allowed.
  template <typename Device>
  void bury(std::unique_ptr<Device> device) {
    if (device) enqueue(std::shared_ptr<void>(std::move(device)));
  }

 private:
  void enqueue(std::shared_ptr<void> device);
  void run(std::stop_token stop);

  Mutex mutex_;
  Condition changed_;
  std::deque<std::shared_ptr<void>> given_up_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last: ends before anything it uses
};

}  // namespace fvd
