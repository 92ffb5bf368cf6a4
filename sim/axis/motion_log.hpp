#pragma once

/// What an axis was told and when it truly moved, as lines of a file: for benchmarks that count motions from outside.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "sim/axis/axis_model.hpp"

namespace fvd::sim {

/// A line is "<ns> move <target um>", "<ns> stop", "<ns> home", "<ns> moving" or "<ns> still"; ns is CLOCK_MONOTONIC.
/// Motion is the true position's, looked at every millisecond. context: the axis calls it on any thread.
class MotionLog {
 public:
  /// Speed above which the axis counts as moving: below any motion of a scan, above drift and ringing.
  static constexpr double kMovingSpeed_um_per_s = 20.0;

  /// The axis outlives the log and is commanded by nobody yet. Throws Error kStorageWrite if the file cannot be made.
  MotionLog(AxisModel& axis, const std::filesystem::path& file);
  ~MotionLog();
  MotionLog(const MotionLog&) = delete;
  MotionLog& operator=(const MotionLog&) = delete;

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void add(HostTime at, const std::string& what);
  void watch(const std::stop_token& stop);

  AxisModel& axis_;
  Mutex mutex_;
  std::unique_ptr<std::FILE, Closer> out_ FVD_GUARDED_BY(mutex_);
  std::jthread thread_;  // last
};

}  // namespace fvd::sim
