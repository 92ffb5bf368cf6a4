#include "daemon/transport/worker.hpp"

#include <utility>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

/// A task reads files and rows, or makes a picture.
constexpr std::chrono::seconds kLongestTask{60};

}  // namespace

Worker::Worker(std::string name)
    : name_(std::move(name)), thread_(start_thread(name_, [this](std::stop_token stop) { run(stop); })) {}

Worker::~Worker() {
  thread_.request_stop();
  thread_.join();
}

void Worker::post(Task task) {
  {
    const MutexLock lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_one();
}

void Worker::run(const std::stop_token& stop) {
  ThreadTicks ticks(name_, kLongestTask);
  for (;;) {
    Task task;
    {
      MutexLock lock(mutex_);
      const bool has_task = changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !tasks_.empty();
      });
      if (!has_task || stop.stop_requested()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    ticks.tick(HostClock::now());
    task();
    ticks.rest();
  }
}

}  // namespace fvd
