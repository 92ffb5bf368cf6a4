#pragma once

/// Which refusals the log tells of, whoever calls: they cost the caller nothing, and must not fill it.

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
  static constexpr std::size_t kMostAPause = 16;     ///< that are told meanwhile, of all: addresses cost nothing either
  static constexpr std::size_t kMostCallers = 1024;  ///< that are known at a time; the one told longest ago gives way

  /// The name of the logger that warns of refusals, with the sinks of the default one: they are no alarms, for a
  /// stranger could push all others out with them.
  static constexpr const char* kLogger = "refused";

  /// Warns that one more is refused, unless enough were told. who: the caller; what: what the log is to say. details:
  /// told beside it at level info; empty = none.
  void tell(const std::string& who, const std::string& what, const std::string& details = {});
  /// One more is refused. If it is to be told, how many there were since the last that was, of whomever, with this one.
  [[nodiscard]] std::optional<std::uint64_t> count_to_tell(const std::string& who, HostTime now);

 private:
  [[nodiscard]] bool is_told(const std::string& who, HostTime now) FVD_REQUIRES(mutex_);

  Mutex mutex_;
  std::map<std::string, HostTime> told_ FVD_GUARDED_BY(mutex_);  // by caller
  HostTime begun_ FVD_GUARDED_BY(mutex_){};                      // a pause, in which so many were told
  std::size_t told_in_it_ FVD_GUARDED_BY(mutex_) = 0;
  std::uint64_t untold_ FVD_GUARDED_BY(mutex_) = 0;
};

}  // namespace fvd
