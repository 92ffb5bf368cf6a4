#include "daemon/views/map_cache.hpp"

#include <algorithm>

namespace fvd {

std::shared_ptr<ResultMaps> MapCache::of(const std::string& job_id, const std::filesystem::path& folder) {
  const MutexLock lock(mutex_);
  trim();  // maps are opened after they were given away
  const auto found = std::find_if(newest_first_.begin(), newest_first_.end(), [&](const Kept& kept) {
    return kept.job_id == job_id && kept.maps->folder() == folder;
  });
  if (found != newest_first_.end()) {
    newest_first_.splice(newest_first_.begin(), newest_first_, found);
  } else {
    newest_first_.push_front({job_id, std::make_shared<ResultMaps>(folder)});
    if (newest_first_.size() > limits_.results) newest_first_.pop_back();
  }
  return newest_first_.front().maps;
}

void MapCache::forget(const std::string& job_id) {
  const MutexLock lock(mutex_);
  newest_first_.remove_if([&job_id](const Kept& kept) { return kept.job_id == job_id; });
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
