#include "core/base/clock.hpp"

#include "core/base/mutex.hpp"

namespace fvd {

void SystemClock::wait_until(HostTime deadline, std::stop_token stop) {
  Mutex mutex;
  Condition wake;
  MutexLock lock(mutex);
  wake.wait_until(lock, stop, deadline, [] { return false; });
}

}  // namespace fvd
