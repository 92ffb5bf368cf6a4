#include "daemon/store/job_status.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "core/base/error.hpp"

namespace fvd {

std::string_view job_state_name(JobState state) noexcept {
  switch (state) {
    case JobState::kProcessing:
      return "processing";
    case JobState::kCompleted:
      return "completed";
    case JobState::kAborted:
      return "aborted";
    case JobState::kFailed:
      return "failed";
  }
  return "failed";
}

void require_not_removed(const JobStatus& job) {
  if (job.removed_utc.empty()) return;
  throw Error(ErrorCode::kResultRemoved, "the result of job " + job.job_id + " was removed at " + job.removed_utc +
                                             " to make room, as the configuration's group store says: job.status " +
                                             "tells what the job came to");
}

std::string utc_text(std::chrono::system_clock::time_point moment) {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(moment);
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> whole{};
  std::strftime(whole.data(), whole.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s.%03dZ", whole.data(),
                static_cast<int>(now.time_since_epoch().count() % 1000));
  return text.data();
}

std::string utc_now() { return utc_text(std::chrono::system_clock::now()); }

std::int64_t seconds_since(const std::string& utc) {
  std::tm then{};
  if (::strptime(utc.c_str(), "%Y-%m-%dT%H:%M:%S", &then) == nullptr) return 0;
  return std::max<std::int64_t>(0, std::time(nullptr) - ::timegm(&then));
}

bool names(const JobKey& key, const JobStatus& job) {
  if (const auto* id = std::get_if<std::string>(&key)) return job.job_id == *id;
  const auto& number = std::get<ClientSeq>(key);
  return job.request.seq == number.seq && job.request.client == number.client;
}

}  // namespace fvd
