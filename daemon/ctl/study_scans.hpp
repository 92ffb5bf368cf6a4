#pragma once

/// Jobs that a study starts itself, one after the other. They MOVE the stage.

#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"
#include "daemon/ctl/rpc_client.hpp"

namespace fvd::ctl {

struct ScanOrder {
  std::string recipe;
  std::string part;
  std::string owner;  ///< the client that counts the sequence numbers
};

/// Starts a job and waits for its end; its id. Throws Error kJobFailed with the reason where it fails.
[[nodiscard]] std::string scan_once(RpcClient& client, const ScanOrder& order);

/// The ids of so many scans of a part that is not moved; says on err that the stage moves.
[[nodiscard]] std::vector<std::string> scan_often(RpcClient& client, const ScanOrder& order, int scans,
                                                  const Terminal& terminal);

/// Asks for each part, operator and trial to put the part in place; the ids part by part. Throws UsageError where
/// nobody is there to be asked.
[[nodiscard]] std::vector<std::string> scan_crossed(RpcClient& client, const ScanOrder& order, int parts, int operators,
                                                    int trials, const Terminal& terminal);

/// The ids in a file, one a line; empty lines and those that begin with # do not count. Throws Error kBadInput.
[[nodiscard]] std::vector<std::string> read_jobs_file(const std::string& file);

}  // namespace fvd::ctl
