#pragma once

/// fvd as a process of its own, and the changes of state and of the part's release in its log.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "tests/bench/motion_watch.hpp"
#include "tests/support/child_process.hpp"

namespace fvd::bench {

/// A change that a line of the log reports.
struct LoggedChange {
  WallTime at;       ///< as logged, to the millisecond
  std::string what;  ///< "started", a state's name, "part_release true", "part_release false", "killed"
};

/// context: one thread; the log is read on a thread of its own.
class WatchedDaemon {
 public:
  /// Starts the program with config/fvd-sim.json and the settings, each as "key=value"; environment: likewise.
  WatchedDaemon(const std::filesystem::path& program, const std::filesystem::path& runtime_dir,
                const std::vector<std::string>& settings, const std::vector<std::string>& environment = {});
  ~WatchedDaemon();
  WatchedDaemon(const WatchedDaemon&) = delete;
  WatchedDaemon& operator=(const WatchedDaemon&) = delete;

  /// The port of the JSON-RPC; 0 if the program does not listen within the time.
  [[nodiscard]] int await_port(std::chrono::seconds within = std::chrono::seconds(20)) const;

  /// SIGKILL; returns when the process is gone.
  void kill();
  [[nodiscard]] std::vector<LoggedChange> changes() const;

 private:
  void read_log();
  void add(WallTime at, std::string what);

  std::filesystem::path port_file_;
  mutable Mutex mutex_;
  std::vector<LoggedChange> changes_ FVD_GUARDED_BY(mutex_);
  test::ChildProcess process_;
  std::jthread reader_;  // last
};

/// The intervals in which clients were told that the part is free. For a program that does not log the release, like
/// version 0.1.0: all times at which its state was not executing.
struct Interval {
  WallTime from;
  WallTime to;
};
[[nodiscard]] std::vector<Interval> released_intervals(const std::vector<LoggedChange>& changes);

}  // namespace fvd::bench
