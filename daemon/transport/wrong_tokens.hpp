#pragma once

/// How long the answer to a wrong token waits: ever longer for each from the same place.

#include <chrono>
#include <map>
#include <string>

#include "core/base/clock.hpp"

namespace fvd {

/// context: one thread.
class WrongTokens {
 public:
  static constexpr std::chrono::milliseconds kFirstDelay{250};
  static constexpr std::chrono::milliseconds kLongestDelay{8000};
  static constexpr std::chrono::seconds kForgotten{60};  ///< without one from there
  static constexpr std::size_t kMostPlaces = 1024;       ///< that are known at a time

  /// One more from there: how long its answer waits. Twice as long as the one before.
  [[nodiscard]] std::chrono::milliseconds delay_of_another(const std::string& address, HostTime now);

 private:
  struct Place {
    std::chrono::milliseconds delay{0};
    HostTime latest{};
  };
  void forget(HostTime now);
  void forget_oldest();

  std::map<std::string, Place> places_;
};

}  // namespace fvd
