#include "daemon/api/refused_calls.hpp"

#include <algorithm>
#include <utility>

namespace fvd {

std::optional<std::uint64_t> RefusedCalls::count_to_tell(const std::string& who, HostTime now) {
  const MutexLock lock(mutex_);
  auto found = callers_.find(who);
  if (found != callers_.end() && now - found->second.told < kPause) {
    ++found->second.untold;
    return std::nullopt;
  }
  if (found == callers_.end()) {
    if (callers_.size() == kMostCallers) {
      callers_.erase(std::min_element(callers_.begin(), callers_.end(),
                                      [](const auto& a, const auto& b) { return a.second.told < b.second.told; }));
    }
    found = callers_.emplace(who, Caller{}).first;
  }
  found->second.told = now;
  return std::exchange(found->second.untold, 0) + 1;
}

}  // namespace fvd
