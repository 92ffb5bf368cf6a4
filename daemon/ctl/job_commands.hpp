#pragma once

/// What fvdctl asks of a running daemon.

#include <optional>
#include <ostream>
#include <string>

#include "daemon/ctl/rpc_client.hpp"

namespace fvd::ctl {

struct StartOptions {
  std::optional<std::int64_t> seq;  ///< absent = one after the client's highest that the daemon knows
  std::string part_id;
  std::string recipe;
  std::optional<double> temperature_c = {};  ///< -50..100, of the part
};

/// The client whose sequence numbers fvdctl uses unless --client says another; the PLC counts its own.
inline constexpr const char* kClientName = "fvdctl";

/// A job as people name it: digits are a sequence number of the client `owner`, anything else a job id; an
/// empty text means the latest job of any client. Returns the parameters that name the job. Throws Error kUnknownJob if
/// there is no job yet.
[[nodiscard]] Json job_key(RpcClient& client, const std::string& job, const std::string& owner = kClientName);

/// Starts a job and returns the reply. owner: the client that counts the sequence number.
[[nodiscard]] Json start_job(RpcClient& client, const StartOptions& options, const std::string& owner = kClientName);

/// Follows a job to its end on `out` and returns its last status. terminal: draw a bar.
[[nodiscard]] Json watch_job(RpcClient& client, const Json& key, std::ostream& out, bool terminal);

/// Waits for the end of a job, prints nothing, and returns its last status.
[[nodiscard]] Json wait_for_job(RpcClient& client, const Json& key);

/// kExitOk for a completed job, kExitJobFailed for one that failed or was aborted.
[[nodiscard]] int job_exit_code(const Json& status);

}  // namespace fvd::ctl
