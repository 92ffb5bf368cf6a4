#pragma once

/// The thread that makes the files of results which no verdict waited for.

#include <cstddef>
#include <deque>
#include <thread>

#include "core/base/mutex.hpp"
#include "daemon/jobs/follow_result.hpp"
#include "daemon/store/job_store.hpp"

namespace fvd {

/// One result after the other, one file at a time, on a thread that gives way to every other: a scan is not slowed.
/// What was not finished when the process ended is taken up by the next one. context: thread-safe.
class FollowingFiles {
 public:
  /// Takes up what `store` tells as pending. store: outlives it.
  explicit FollowingFiles(JobStore& store);
  /// finish().
  ~FollowingFiles();
  FollowingFiles(const FollowingFiles&) = delete;
  FollowingFiles& operator=(const FollowingFiles&) = delete;

  /// To be called once.
  void start();

  /// Of a job whose row is stored.
  void add(ResultToFollow result);

  /// Memory that the results that are not finished take, or will.
  [[nodiscard]] std::size_t bytes() const;
  /// Waits until they take no more than this. False if a stop was requested before.
  bool wait_for(std::size_t most_bytes, const std::stop_token& stop);

  /// Asks the thread to end within the file that it makes; returns at once.
  void request_stop();
  /// request_stop(), then waits for that.
  void finish();

 private:
  void run(const std::stop_token& stop);
  void follow(ResultToFollow result, const std::stop_token& stop);
  [[nodiscard]] std::size_t bytes_locked() const FVD_REQUIRES(mutex_);

  struct Waiting {
    ResultToFollow result;
    std::size_t written_bytes = 0;
    std::size_t working_bytes = 0;
  };
  [[nodiscard]] static Waiting sized(ResultToFollow result);

  JobStore& store_;
  mutable Mutex mutex_;
  Condition changed_;
  std::deque<Waiting> waiting_ FVD_GUARDED_BY(mutex_);
  std::size_t running_bytes_ FVD_GUARDED_BY(mutex_) = 0;  // of the one that is being made
  std::jthread thread_;                                   // last: ends before anything it uses
};

}  // namespace fvd
