#pragma once

/// Which refusals of strangers the log tells of: they cost the caller nothing, and must not fill it.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"

namespace fvd {

/// context: thread-safe.
class RefusedCalls {
 public:
  static constexpr std::chrono::seconds kPause{1};   ///< between two that are told, of one caller
  static constexpr std::size_t kMostCallers = 1024;  ///< that are known at a time; the one told longest ago gives way

  /// One more is refused. If it is to be told, how many there were since the last that was, with this one.
  [[nodiscard]] std::optional<std::uint64_t> count_to_tell(const std::string& who, HostTime now);

 private:
  struct Caller {
    std::uint64_t untold = 0;
    HostTime told{};
  };

  Mutex mutex_;
  std::map<std::string, Caller> callers_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
