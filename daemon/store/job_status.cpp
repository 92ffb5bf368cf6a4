#include "daemon/store/job_status.hpp"

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

bool names(const JobKey& key, const JobStatus& job) {
  if (const auto* id = std::get_if<std::string>(&key)) return job.job_id == *id;
  const auto& number = std::get<ClientSeq>(key);
  return job.request.seq == number.seq && job.request.client == number.client;
}

}  // namespace fvd
