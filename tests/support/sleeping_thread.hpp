#pragma once

/// A thread whose waiting a test can detect.

#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <sys/types.h>
#include <unistd.h>

namespace fvd::test {

class SleepingThread {
 public:
  explicit SleepingThread(std::function<void(std::stop_token)> body)
      : thread_([this, body = std::move(body)](std::stop_token stop) {
          id_ = ::gettid();
          body(std::move(stop));
        }) {}

  void request_stop() { thread_.request_stop(); }

  /// Polls until the operating system reports that the thread sleeps; false after 10 s. The body must not sleep
  /// anywhere but in the wait in question.
  [[nodiscard]] bool sleeps() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < deadline) {
      if (id_ != 0 && state() == 'S') return true;
      std::this_thread::yield();
    }
    return false;
  }

 private:
  /// The letter of proc(5), after the name in brackets.
  [[nodiscard]] char state() const {
    std::ifstream file("/proc/self/task/" + std::to_string(id_) + "/stat");
    std::string line;
    std::getline(file, line);
    const auto bracket = line.rfind(") ");
    return bracket == std::string::npos || bracket + 2 >= line.size() ? '?' : line[bracket + 2];
  }

  std::atomic<pid_t> id_{0};
  std::jthread thread_;  // last
};

}  // namespace fvd::test
