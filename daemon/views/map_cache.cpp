#include "daemon/views/map_cache.hpp"

#include <algorithm>
#include <utility>

#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kLookPeriod{15};
constexpr std::chrono::seconds kLongestDrop{60};  // closes files and gives memory back

}  // namespace

std::shared_ptr<ResultMaps> MapCache::of(const std::string& job_id, const std::filesystem::path& folder, HostTime now) {
  const MutexLock lock(mutex_);
  if (!sweeper_.joinable()) sweeper_ = start_thread("fvd-maps", [this](const std::stop_token& stop) { run(stop); });
  trim();  // maps are opened after they were given away
  const auto found = std::find_if(newest_first_.begin(), newest_first_.end(), [&](const Kept& kept) {
    return kept.job_id == job_id && kept.maps->folder() == folder;
  });
  if (found != newest_first_.end()) {
    newest_first_.splice(newest_first_.begin(), newest_first_, found);
  } else {
    newest_first_.push_front({job_id, std::make_shared<ResultMaps>(folder), now});
    if (newest_first_.size() > limits_.results) newest_first_.pop_back();
  }
  newest_first_.front().used = now;
  changed_.notify_all();
  return newest_first_.front().maps;
}

void MapCache::forget(const std::string& job_id) {
  const MutexLock lock(mutex_);
  newest_first_.remove_if([&job_id](const Kept& kept) { return kept.job_id == job_id; });
}

void MapCache::drop_unused(HostTime now) {
  std::list<Kept> dropped;  // nobody waits for its end
  const MutexLock lock(mutex_);
  const auto unused = std::find_if(newest_first_.begin(), newest_first_.end(),
                                   [now](const Kept& kept) { return now - kept.used > kLongestUnused; });
  dropped.splice(dropped.begin(), newest_first_, unused, newest_first_.end());
}

void MapCache::run(const std::stop_token& stop) {
  ThreadTicks ticks("fvd-maps", kLongestDrop);
  for (;;) {
    {
      MutexLock lock(mutex_);
      const bool keeps = changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !newest_first_.empty();
      });
      if (!keeps || stop.stop_requested()) return;
      changed_.wait_for(lock, stop, kLookPeriod, [] { return false; });
      if (stop.stop_requested()) return;
    }
    ticks.tick(HostClock::now());
    drop_unused(HostClock::now());
    ticks.rest();
  }
}

std::size_t MapCache::size() const {
  const MutexLock lock(mutex_);
  return newest_first_.size();
}

void MapCache::trim() {
  std::size_t sum = 0;
  auto kept = newest_first_.begin();
  while (kept != newest_first_.end()) {
    const std::size_t bytes = kept->maps->bytes();
    if (sum + bytes > limits_.bytes) {
      kept = newest_first_.erase(kept);
    } else {
      sum += bytes;
      ++kept;
    }
  }
}

}  // namespace fvd
