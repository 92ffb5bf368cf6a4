#pragma once

/// The one thread that talks to an Aravis device.

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <stop_token>
#include <thread>
#include <type_traits>
#include <utility>

#include "core/base/mutex.hpp"

namespace fvd {

/// Aravis devices are not thread-safe, and a command to a camera that no longer answers blocks for 2.5 s: the caller
/// decides how long to wait on the future. context: thread-safe.
class DeviceThread {
 public:
  DeviceThread();
  /// Waits for the running command; drops those behind it, whose futures throw std::future_error.
  ~DeviceThread();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// Appends a command; commands run one after the other. The future rethrows what the command throws.
  template <typename Command>
  [[nodiscard]] std::future<std::invoke_result_t<Command>> post(Command command) {
    auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Command>()>>(std::move(command));
    auto result = task->get_future();
    enqueue([task] { (*task)(); });
    return result;
  }

 private:
  void enqueue(std::function<void()> command);
  void run(std::stop_token stop);

  Mutex mutex_;
  Condition changed_;
  std::deque<std::function<void()>> commands_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd
