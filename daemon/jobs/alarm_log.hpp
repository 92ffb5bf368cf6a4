#pragma once

/// Warnings and errors of the log, in memory, until somebody has seen them.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string_view>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/jobs/services.hpp"

namespace fvd {

/// A line that comes again within a minute is counted, and pushes no other out, unless it was acknowledged meanwhile:
/// then it is an alarm of its own. Where one too many is kept, the oldest goes of those that were acknowledged; else of
/// the warnings, were it the newest line; else of the errors; else of the critical ones. context: thread-safe; blocks
/// for nothing, and logs nothing.
class AlarmLog final : public AlarmService {
 public:
  static constexpr std::size_t kMostKept = 200;
  static constexpr std::size_t kLongestText_bytes = 500;
  static constexpr std::chrono::seconds kRepeatTime{60};

  /// text: of a line; any bytes. What is no UTF-8 is told as "?", and a longer text ends with "...".
  void note(AlarmLevel level, std::string_view text, std::chrono::system_clock::time_point time);

  [[nodiscard]] std::vector<Alarm> newest() const override;
  void acknowledge(std::int64_t number, std::string_view time_utc) override;
  [[nodiscard]] std::uint64_t revision() const noexcept override { return revision_; }

 private:
  struct Kept {
    Alarm alarm;
    std::chrono::system_clock::time_point last;
  };

  mutable Mutex mutex_;
  std::deque<Kept> kept_ FVD_GUARDED_BY(mutex_);  ///< the oldest first
  std::int64_t newest_number_ FVD_GUARDED_BY(mutex_) = 0;
  std::atomic<std::uint64_t> revision_{0};  ///< counted under the mutex, read without
};

}  // namespace fvd
