#include "drivers/replay/time_stamp.hpp"

#include <chrono>
#include <cmath>
#include <regex>

namespace fvd {

std::optional<TimeStamp> find_time_stamp(const std::string& name) {
  static const std::regex kFormat(
      "(?:^|[^0-9])"
      "((?:19|20)[0-9]{2})[-_.]?(0[1-9]|1[0-2])[-_.]?(0[1-9]|[12][0-9]|3[01])"
      "(?:T|[-_. ]+(?:at )?|)"
      "([01][0-9]|2[0-3])[-_.:h]?([0-5][0-9])[-_.:m]?([0-5][0-9])([0-9]{3}|[0-9]{6})?"
      "(?![0-9])");
  std::smatch match;
  if (!std::regex_search(name, match, kFormat)) return std::nullopt;
  const auto number = [&match](std::size_t group) { return std::stoi(match[group].str()); };
  const std::chrono::sys_days day = std::chrono::year(number(1)) / number(2) / number(3);
  const double fraction = match[7].matched ? number(7) * std::pow(10.0, -static_cast<double>(match[7].length())) : 0.0;
  const auto first = static_cast<std::size_t>(match.position(1));
  const auto end = static_cast<std::size_t>(match.position(0) + match.length(0));
  return TimeStamp{first, end - first,
                   static_cast<double>(day.time_since_epoch().count()) * 86400.0 + number(4) * 3600.0 +
                       number(5) * 60.0 + number(6) + fraction};
}

}  // namespace fvd
