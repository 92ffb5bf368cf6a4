#include "daemon/ctl/stop_on_signal.hpp"

#include <ctime>

#include "core/runtime/guarded_thread.hpp"

namespace fvd::ctl {

StopOnSignal::StopOnSignal() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) sigaddset(&signals_, SIGHUP);  // nohup means to go on
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  watcher_ = start_thread("fvdctl-signals", [this](const std::stop_token& ended) {
    constexpr timespec kPollInterval{0, 100'000'000};
    while (!ended.stop_requested()) {
      if (sigtimedwait(&signals_, nullptr, &kPollInterval) > 0) source_.request_stop();
    }
  });
}

StopOnSignal::~StopOnSignal() {
  watcher_ = {};
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace fvd::ctl
