#pragma once

/// Studies as lines for people.

#include <string>

#include "daemon/ctl/rpc_client.hpp"

namespace fvd::ctl {

/// Of the reply to a method that makes a study: figures with U, refusals, warnings, where it is kept.
[[nodiscard]] std::string study_text(const Json& reply);
/// Of the reply to study.list.
[[nodiscard]] std::string study_list_text(const Json& reply);
/// kExitOk, or kExitVerdictFail where a gauge is not capable.
[[nodiscard]] int study_exit_code(const Json& reply);

}  // namespace fvd::ctl
