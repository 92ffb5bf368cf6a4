#pragma once

/// A job as its client asked for it and as it stands.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/scan/frame_ledger.hpp"
#include "daemon/store/stored_value.hpp"

namespace fvd {

/// The name of a client that gives none: a plain PLC.
inline constexpr const char* kDefaultClient = "plc";

struct JobRequest {
  std::int64_t seq = 0;                 ///< the client's sequence number, 1..2^53-1; the same number is the same job
  std::string part_id;                  ///< 1..64 printable ASCII characters
  std::string recipe;                   ///< recipe id; empty = the prepared one
  std::string client = kDefaultClient;  ///< whose seq it is
  std::optional<double> temperature_c = {};  ///< -50..100, of the part; absent = not given
  std::string session = {};  ///< of the client, which names it as it likes; a number is never repeated in another one
  HostTime asked = {};       ///< when the request came; none = unknown. Not stored
};

/// OPC 40100-1 result states: processing, completed, aborted, failed.
enum class JobState { kProcessing, kCompleted, kAborted, kFailed };
[[nodiscard]] std::string_view job_state_name(JobState state) noexcept;

struct JobStatus {
  std::string job_id;
  JobRequest request;
  JobState state = JobState::kProcessing;
  std::string phase;      ///< "preparing", "acquiring", "computing", "storing", "" when ended
  bool acquired = false;  ///< the part may be moved: no more slices, and standstill was measured
  int slices_done = 0;
  int slices_planned = 0;
  FrameCounts frames;
  std::optional<ErrorCode> error;  ///< why it failed or was aborted
  std::string error_message;
  bool acknowledged = false;  ///< result.ack was received
  std::string not_durable;    ///< why its end is not on disk yet; empty = it is, or the job has not ended
  std::string ended_utc;      ///< 2026-11-30T10:00:00.000Z; empty = it has not ended
  std::string verdict;        ///< pass, fail, uncertain, invalid; empty = nothing was judged
  std::string reason_codes;   ///< why values are missing or uncertain, numbers on the wire: "1122,1145"; may be empty
  std::string removed_utc;    ///< when its result was removed to make room; empty = it was not
};

/// Throws Error kResultRemoved where the job's result was removed, and says when.
void require_not_removed(const JobStatus& job);

/// A moment as ended_utc tells it, to the millisecond.
[[nodiscard]] std::string utc_text(std::chrono::system_clock::time_point moment);
/// This moment.
[[nodiscard]] std::string utc_now();
/// Seconds since a moment that utc_now() told; 0 for one that lies ahead, because clocks are set, and for no moment.
[[nodiscard]] std::int64_t seconds_since(const std::string& utc);

/// A sequence number belongs to the client that chose it.
struct ClientSeq {
  std::int64_t seq = 0;
  std::string client = kDefaultClient;
};

/// A job by id or by its client's sequence number.
using JobKey = std::variant<std::string, ClientSeq>;

/// True if the key is this job's.
[[nodiscard]] bool names(const JobKey& key, const JobStatus& job);

struct StoredJob {
  JobStatus status;
  std::string result_dir;             ///< empty = no result
  std::string result_json;            ///< text of result.json, empty = no result
  bool files_pending = false;         ///< files of the result are still to be made
  std::vector<StoredValue> values{};  ///< of the result, on the way into the database; JobHistory gives them back
};

}  // namespace fvd
