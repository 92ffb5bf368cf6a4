#include "daemon/store/job_id.hpp"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <ctime>

namespace fvd {

std::string make_job_id(std::chrono::system_clock::time_point now, std::int64_t epoch, std::int64_t number) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> time{};
  std::strftime(time.data(), time.size(), "%Y%m%dT%H%M%SZ", &utc);
  std::array<char, 80> id{};
  std::snprintf(id.data(), id.size(), "%s-%05" PRId64 "-%06" PRId64, time.data(), epoch, number);
  return id.data();
}

}  // namespace fvd
