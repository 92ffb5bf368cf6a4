#include "daemon/access/refused_calls.hpp"

#include <algorithm>
#include <utility>

#include <spdlog/spdlog.h>

namespace fvd {

void RefusedCalls::tell(const std::string& who, const std::string& what, const std::string& details) {
  const auto count = count_to_tell(who, HostClock::now());
  if (!count) return;
  // A logger of its own: whoever collects warnings tells these from those of the machine by its name.
  spdlog::default_logger()->clone(kLogger)->warn("{}; {} were refused since the last that was told", what, *count);
  if (!details.empty()) spdlog::info("details: {}", details);
}

std::optional<std::uint64_t> RefusedCalls::count_to_tell(const std::string& who, HostTime now) {
  const MutexLock lock(mutex_);
  ++untold_;
  if (!is_told(who, now)) return std::nullopt;
  return std::exchange(untold_, 0);
}

bool RefusedCalls::is_told(const std::string& who, HostTime now) {
  const auto known = told_.find(who);
  if (known != told_.end() && now - known->second < kPause) return false;
  if (now - begun_ >= kPause) {
    begun_ = now;
    told_in_it_ = 0;
  }
  if (told_in_it_ == kMostAPause) return false;
  ++told_in_it_;
  if (known == told_.end() && told_.size() == kMostCallers) {
    told_.erase(
        std::min_element(told_.begin(), told_.end(), [](const auto& a, const auto& b) { return a.second < b.second; }));
  }
  told_[who] = now;
  return true;
}

}  // namespace fvd
