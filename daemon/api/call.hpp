#pragma once

/// What a method is given and what it gives.

#include <chrono>
#include <memory>
#include <string>
#include <variant>

#include <nlohmann/json.hpp>

#include "daemon/api/caller.hpp"
#include "daemon/api/reply_form.hpp"
#include "daemon/jobs/device_task.hpp"

namespace fvd {

/// context: lives as long as the call.
struct Call {
  const Caller& caller;
  const std::string& method;
  const nlohmann::json& params;    ///< an object, checked against the method's description
  bool may_wait = false;           ///< the reply may come later: not in a batch, not without an id
  std::size_t envelope_bytes = 0;  ///< of the reply around its result, with the end of the line
};

/// The result.
using Reply = nlohmann::ordered_json;

/// The reply comes when a job has got so far (until_acquired, else until it has ended).
struct JobWait {
  std::string job_id;
  bool until_acquired = false;
  ReplyForm form{};
};

/// The reply comes later.
struct Deferred {
  std::variant<JobWait, std::shared_ptr<DeviceTask>> awaited;
  std::chrono::milliseconds timeout{0};
};

/// The caller is somebody else from now on.
struct LogIn {
  Identity who;
  Reply reply;
};

using Answer = std::variant<Reply, Deferred, LogIn>;

}  // namespace fvd
