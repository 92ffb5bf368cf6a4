#pragma once

/// Makes room for new results: a thread that removes old ones as the configuration says.

#include <cstdint>
#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "daemon/config/config.hpp"
#include "daemon/store/job_store.hpp"
#include "daemon/store/retention_plan.hpp"

namespace fvd {

/// A result is first told as removed, durably, and then removed: a process that is killed between the two goes on at
/// the next start. The evaluations of a result count and go with it. Each removal is logged, and each that fails.
/// context: one thread, beside its own.
class Retention {
 public:
  /// What they refer to outlives it.
  Retention(JobStore& store, const StoreConfig& config, std::filesystem::path results);
  ~Retention() { finish(); }
  Retention(const Retention&) = delete;
  Retention& operator=(const Retention&) = delete;

  /// Looks at once, and once a minute, while a limit is set.
  void start();
  /// Other limits, by which it looks at once. context: any thread.
  void set_limits(const StoreConfig& limits);
  void finish();

  /// Looks once. Never throws. context: not after start().
  void run_once(const std::stop_token& stop = {}) noexcept;

 private:
  struct Size {
    std::uint64_t bytes = 0;
    std::uint64_t slices_bytes = 0;
  };
  [[nodiscard]] StoreConfig config() const {
    const MutexLock lock(mutex_);
    return config_;
  }
  void run(const std::stop_token& stop);
  void finish_removals();
  void make_room(const std::stop_token& stop);
  [[nodiscard]] Size size_of(const std::string& job_id);
  [[nodiscard]] std::uint64_t evaluation_bytes(const std::string& job_id);
  void remove_result(const StoredJob& job);
  /// Of the job's result and of its evaluations.
  void remove_folders(const std::string& job_id);
  void remove_slices(const StoredJob& job);
  /// Warns once where all that may go has gone, and the disk still has less free than it should.
  void note_shortage();

  JobStore& store_;
  mutable Mutex mutex_;
  Condition limits_changed_;
  StoreConfig config_ FVD_GUARDED_BY(mutex_);
  bool has_other_limits_ FVD_GUARDED_BY(mutex_) = false;  // that it has not looked by
  const std::filesystem::path results_;
  bool is_short_ = false;                                        // and that was told
  std::map<std::string, Size> sizes_;                            // of results that do not change any more
  std::map<std::string, std::vector<std::string>> evaluations_;  // on the disk, by job
  ThreadTicks ticks_;
  std::jthread thread_;  // last: ends before anything it uses
};

}  // namespace fvd
