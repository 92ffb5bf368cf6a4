#pragma once

/// Ctrl-C, and a terminal that is closed, halt what moves instead of ending the program.

#include <csignal>
#include <stop_token>
#include <thread>

namespace fvd::ctl {

/// While it lives SIGINT, SIGTERM and SIGHUP (unless that is ignored, as under nohup) request a stop. context: one at a
/// time.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  sigset_t signals_{};
  sigset_t before_{};
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace fvd::ctl
