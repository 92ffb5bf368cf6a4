#include "drivers/aravis/device_thread.hpp"

#include <pthread.h>

namespace fvd {

DeviceThread::DeviceThread() : thread_([this](std::stop_token stop) { run(stop); }) {
  pthread_setname_np(thread_.native_handle(), "fvd-camera");
}

DeviceThread::~DeviceThread() {
  thread_.request_stop();
  thread_.join();
}

void DeviceThread::enqueue(std::function<void()> command) {
  {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
  }
  changed_.notify_one();
}

void DeviceThread::run(std::stop_token stop) {
  for (;;) {
    std::function<void()> command;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return !commands_.empty(); }) || stop.stop_requested()) return;
      command = std::move(commands_.front());
      commands_.pop_front();
    }
    command();
  }
}

}  // namespace fvd
