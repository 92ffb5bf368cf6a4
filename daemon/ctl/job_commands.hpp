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
};

/// Sequence numbers belong to a client: those of fvdctl are never the PLC's.
inline constexpr const char* kClientName = "fvdctl";

/// A job as people name it: digits are a sequence number of the client `owner`, anything else a job id, empty the
/// latest job of all. Returns the parameters that name it. Throws Error kUnknownJob if there is no job yet.
[[nodiscard]] Json job_key(RpcClient& client, const std::string& job, const std::string& owner = kClientName);

/// The accepted job. owner: the client whose sequence number it gets.
[[nodiscard]] Json start_job(RpcClient& client, const StartOptions& options, const std::string& owner = kClientName);

/// Follows a job to its end on `out` and returns its last status. terminal: draw a bar.
[[nodiscard]] Json watch_job(RpcClient& client, const Json& key, std::ostream& out, bool terminal);

/// Waits for the end of a job without a word.
[[nodiscard]] Json wait_for_job(RpcClient& client, const Json& key);

/// 0 for a completed job, 1 for one that failed or was aborted.
[[nodiscard]] int job_exit_code(const Json& status);

}  // namespace fvd::ctl
