#pragma once

/// The parameters that name a job, and the client whose numbers are meant.

#include <cstdint>
#include <optional>
#include <string>

#include "config/fields.hpp"
#include "daemon/api/reply_form.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// For every method that takes a sequence number.
struct ClientParam {
  std::string client = kDefaultClient;
  void describe(Fields& fields);
  /// Throws ProtocolError unless it is a name.
  [[nodiscard]] const std::string& checked() const;
};

/// job_id or seq. client is described apart, as the last parameter.
struct JobKeyParams {
  std::optional<std::string> job_id;
  std::optional<std::int64_t> seq;
  void describe(Fields& fields);
  /// Throws ProtocolError unless one of the two is there.
  [[nodiscard]] JobKey key(const ClientParam& client) const;
};

/// Both, for methods that take nothing else.
struct OneJobParams {
  JobKeyParams job;
  ClientParam client;
  void describe(Fields& fields);
  [[nodiscard]] JobKey key() const { return job.key(client); }
};

/// The same for methods that tell a job's status.
struct JobStatusParams {
  JobKeyParams job;
  ClientParam client;
  ReplyFormParams form;
  void describe(Fields& fields);
  [[nodiscard]] JobKey key() const { return job.key(client); }
};

/// A sequence number.
void describe_seq(Fields& fields, std::int64_t& seq, std::string_view meaning);

}  // namespace fvd
