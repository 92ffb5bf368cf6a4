#include "daemon/transport/wrong_tokens.hpp"

#include <algorithm>

namespace fvd {

std::chrono::milliseconds WrongTokens::delay_of_another(const std::string& address, HostTime now) {
  forget(now);
  if (places_.count(address) == 0 && places_.size() == kMostPlaces) forget_oldest();
  Place& place = places_[address];
  place.delay = place.delay.count() == 0 ? kFirstDelay : std::min(2 * place.delay, kLongestDelay);
  place.latest = now;
  return place.delay;
}

void WrongTokens::forget(HostTime now) {
  std::erase_if(places_, [now](const auto& entry) { return now - entry.second.latest > kForgotten; });
}

void WrongTokens::forget_oldest() {
  places_.erase(std::min_element(places_.begin(), places_.end(),
                                 [](const auto& a, const auto& b) { return a.second.latest < b.second.latest; }));
}

}  // namespace fvd
