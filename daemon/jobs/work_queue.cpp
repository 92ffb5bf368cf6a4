#include "daemon/jobs/work_queue.hpp"

#include <utility>

namespace fvd {

bool WorkQueue::post(Work work) {
  {
    const MutexLock lock(mutex_);
    if (closed_) return false;
    waiting_.push_back(std::move(work));
  }
  changed_.notify_one();
  return true;
}

std::optional<Work> WorkQueue::take(std::stop_token stop, std::chrono::milliseconds patience) {
  MutexLock lock(mutex_);
  const bool found = changed_.wait_for(lock, stop, patience, [this] {
    mutex_.assert_held();
    return !waiting_.empty();
  });
  if (!found || stop.stop_requested()) return std::nullopt;
  Work work = std::move(waiting_.front());
  waiting_.pop_front();
  return work;
}

void WorkQueue::close() {
  std::deque<Work> refused;
  {
    const MutexLock lock(mutex_);
    closed_ = true;
    refused = std::exchange(waiting_, {});
  }
  for (const Work& work : refused) work.refuse();
}

}  // namespace fvd
