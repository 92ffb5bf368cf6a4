#include "daemon/report/time_text.hpp"

#include <ctime>

namespace fvd {

namespace {

std::string formatted(std::chrono::system_clock::time_point time, const char* format) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(std::chrono::floor<std::chrono::seconds>(time));
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[64] = "";
  std::strftime(text, sizeof text, format, &parts);
  return text;
}

}  // namespace

std::string iso_time_text(std::chrono::system_clock::time_point time) { return formatted(time, "%Y-%m-%dT%H:%M:%SZ"); }

std::string people_time_text(std::chrono::system_clock::time_point time) {
  return formatted(time, "%Y-%m-%d %H:%M:%S UTC");
}

}  // namespace fvd
