#include "daemon/export/json_values.hpp"

#include <cmath>
#include <ctime>

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

}  // namespace fvd
