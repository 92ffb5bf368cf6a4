#pragma once

/// Buries devices on a thread of its own: closing a camera that no longer answers takes many seconds.

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

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

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<std::shared_ptr<void>> dead_;  // guarded by mutex_
  std::jthread thread_;
};

}  // namespace fvd
