#include "drivers/aravis/device_thread.hpp"

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// Aravis gives a command up after 2.5 s; opening a stream takes several of them.
constexpr std::chrono::seconds kLongestCommand{60};

}  // namespace

DeviceThread::DeviceThread() : thread_(start_thread("fvd-camera", [this](std::stop_token stop) { run(stop); })) {}

DeviceThread::~DeviceThread() {
  thread_.request_stop();
  thread_.join();
}

void DeviceThread::enqueue(std::function<void()> command) {
  {
    const MutexLock lock(mutex_);
    commands_.push_back(std::move(command));
  }
  changed_.notify_one();
}

void DeviceThread::run(std::stop_token stop) {
  ThreadTicks ticks("fvd-camera", kLongestCommand);
  const auto waiting = [this] {
    mutex_.assert_held();
    return !commands_.empty();
  };
  for (;;) {
    std::function<void()> command;
    {
      MutexLock lock(mutex_);
      if (!changed_.wait(lock, stop, waiting) || stop.stop_requested()) return;
      command = std::move(commands_.front());
      commands_.pop_front();
    }
    ticks.tick(HostClock::now());
    command();
    ticks.rest();
  }
}

}  // namespace fvd
