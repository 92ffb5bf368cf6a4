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

}  // namespace fvd
