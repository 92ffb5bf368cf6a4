#include "core/runtime/guarded_thread.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include <pthread.h>

#include "core/base/exception_text.hpp"
#include "core/base/mutex.hpp"

namespace fvd {

namespace {

/// The process' handler; made at its first use, so that no other object's start or end comes before it.
class ProcessHandler {
 public:
  static ProcessHandler& instance() {
    static ProcessHandler handler;
    return handler;
  }
  void set(ThreadFailure handler) {
    const MutexLock lock(mutex_);
    handler_ = std::move(handler);
  }
  [[nodiscard]] ThreadFailure get() {
    const MutexLock lock(mutex_);
    return handler_;
  }

 private:
  Mutex mutex_;
  ThreadFailure handler_ FVD_GUARDED_BY(mutex_);
};

[[noreturn]] void abort_program(const std::string& name, const std::exception_ptr& failure) {
  std::fprintf(stderr, "thread %s ended by an exception: %s\n", name.c_str(), exception_text(failure).c_str());
  std::abort();
}

void run_guarded(const std::string& name, const std::function<void(std::stop_token)>& body,
                 const ThreadFailure& on_failure, std::stop_token stop) {
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());
  try {
    body(std::move(stop));
  } catch (...) {
    const ThreadFailure handler = on_failure ? on_failure : ProcessHandler::instance().get();
    if (!handler) abort_program(name, std::current_exception());
    handler(name, std::current_exception());
  }
}

}  // namespace

std::jthread start_thread(std::string name, std::function<void(std::stop_token)> body, ThreadFailure on_failure) {
  return std::jthread([name = std::move(name), body = std::move(body), on_failure = std::move(on_failure)](
                          std::stop_token stop) { run_guarded(name, body, on_failure, std::move(stop)); });
}

void set_thread_failure_handler(ThreadFailure handler) { ProcessHandler::instance().set(std::move(handler)); }

}  // namespace fvd
