#pragma once

/// A wait that ends early when somebody asks for it.

#include <chrono>
#include <stop_token>

#include "core/base/mutex.hpp"

namespace fvd {

/// False when the wait was ended by a stop request.
inline bool pause(std::chrono::milliseconds time, const std::stop_token& stop) {
  Mutex mutex;
  Condition never;
  MutexLock lock(mutex);
  never.wait_for(lock, stop, time, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace fvd
