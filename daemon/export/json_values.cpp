#include "daemon/export/json_values.hpp"

#include <cmath>
#include <ctime>
#include <string_view>

namespace fvd {

using Json = nlohmann::ordered_json;

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json rounded(const std::optional<double>& value, int decimals) {
  if (!value) return nullptr;
  const double factor = std::pow(10.0, decimals);
  const double result = std::round(*value * factor) / factor;
  return std::isfinite(result) ? Json(result) : Json(nullptr);
}

std::string iso8601_utc(std::chrono::system_clock::time_point time) {
  const auto millis = std::chrono::floor<std::chrono::milliseconds>(time);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(millis);
  const std::time_t t = std::chrono::system_clock::to_time_t(seconds);
  std::tm utc{};
  gmtime_r(&t, &utc);
  char text[64];
  const auto length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  const std::string fraction = std::to_string(1000 + (millis - seconds).count()).substr(1);
  return std::string(text, length) + "." + fraction + "Z";
}

std::optional<std::chrono::system_clock::time_point> from_iso8601_utc(const std::string& text) {
  std::tm utc{};
  const char* const rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &utc);
  if (rest == nullptr) return std::nullopt;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::string_view fraction(rest);  // ".123Z"
  if (fraction.size() != 5 || fraction[0] != '.' || fraction[4] != 'Z') return std::nullopt;
  int millis = 0;
  for (const char c : fraction.substr(1, 3)) {
    if (!is_digit(c)) return std::nullopt;
    millis = 10 * millis + (c - '0');
  }
  return std::chrono::system_clock::from_time_t(timegm(&utc)) + std::chrono::milliseconds(millis);
}

}  // namespace fvd
