#include "core/base/clock.hpp"

#include <condition_variable>
#include <mutex>

namespace fvd {

void SystemClock::wait_until(HostTime deadline, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_until(lock, stop, deadline, [] { return false; });
}

}  // namespace fvd
