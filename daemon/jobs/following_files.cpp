#include "daemon/jobs/following_files.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/export/result_json.hpp"

namespace fvd {

namespace {

/// A tenth of a busy processor: less, and files stay pending as long as anything else computes.
constexpr int kNice = 10;

constexpr const char* kThread = "fvd-follow";

/// Of one result, while everything else goes first.
constexpr std::chrono::minutes kLongestResult{30};

}  // namespace

FollowingFiles::Waiting FollowingFiles::sized(ResultToFollow result) {
  Waiting waiting;
  for (const WrittenBytes& written : result.written) waiting.written_bytes += written.bytes.size();
  try {
    waiting.working_bytes = follow_bytes(read_result_json(result.text));
  } catch (const Error&) {
    waiting.working_bytes = 0;  // follow() tells what is wrong with it
  }
  waiting.result = std::move(result);
  return waiting;
}

FollowingFiles::FollowingFiles(JobStore& store) : store_(store) {
  std::deque<Waiting> left;
  for (StoredJob& job : store.with_pending_files()) {
    spdlog::info("job {}: files of its result are pending since the last stop", job.status.job_id);
    left.push_back(sized({job.status.job_id, job.result_dir, std::move(job.result_json), {}}));
  }
  const MutexLock lock(mutex_);
  waiting_ = std::move(left);
}

FollowingFiles::~FollowingFiles() { finish(); }

void FollowingFiles::start() {
  thread_ = start_thread(kThread, [this](const std::stop_token& stop) { run(stop); });
}

void FollowingFiles::add(ResultToFollow result) {
  Waiting waiting = sized(std::move(result));
  {
    const MutexLock lock(mutex_);
    waiting_.push_back(std::move(waiting));
  }
  changed_.notify_all();
}

std::size_t FollowingFiles::bytes_locked() const {
  std::size_t written = 0;
  std::size_t working = 0;  // of the next one; the others wait for it
  for (const Waiting& waiting : waiting_) {
    written += waiting.written_bytes;
    working = std::max(working, waiting.working_bytes);
  }
  return written + std::max(running_bytes_, working);
}

std::size_t FollowingFiles::bytes() const {
  const MutexLock lock(mutex_);
  return bytes_locked();
}

bool FollowingFiles::wait_for(std::size_t most_bytes, const std::stop_token& stop) {
  MutexLock lock(mutex_);
  return changed_.wait(lock, stop, [this, most_bytes] {
    mutex_.assert_held();
    return bytes_locked() <= most_bytes;
  });
}

void FollowingFiles::request_stop() { thread_.request_stop(); }

void FollowingFiles::finish() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

void FollowingFiles::run(const std::stop_token& stop) {
  // Of this thread alone, as Linux takes it. Where it is not allowed, files are made all the same.
  (void)::setpriority(PRIO_PROCESS, 0, kNice);
  ThreadTicks ticks(kThread, kLongestResult);
  while (true) {
    ResultToFollow next;
    {
      MutexLock lock(mutex_);
      const bool found = changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !waiting_.empty();
      });
      if (!found || stop.stop_requested()) return;
      running_bytes_ = waiting_.front().written_bytes + waiting_.front().working_bytes;
      next = std::move(waiting_.front().result);
      waiting_.pop_front();
    }
    ticks.tick(HostClock::now());
    follow(std::move(next), stop);
    ticks.rest();
    {
      const MutexLock lock(mutex_);
      running_bytes_ = 0;
    }
    changed_.notify_all();
  }
}

void FollowingFiles::follow(ResultToFollow result, const std::stop_token& stop) {
  const std::string job_id = result.job_id;
  try {
    const FollowedResult followed = follow_result(std::move(result), stop);
    store_.shorten_log();  // before the commit, which begins the log anew: that costs it a sync more
    store_.note_files(job_id, followed.text, followed.pending);
    if (followed.pending) {
      spdlog::warn("job {}: files of its result stay pending until the daemon starts again: {}", job_id,
                   followed.reason.empty() ? "it stops" : followed.reason);
    }
  } catch (const std::exception& failure) {
    spdlog::error("job {}: files of its result stay pending until the daemon starts again: {}", job_id, failure.what());
  }
}

}  // namespace fvd
