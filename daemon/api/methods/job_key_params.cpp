#include "daemon/api/methods/job_key_params.hpp"

#include "daemon/api/caller.hpp"
#include "daemon/api/json_shapes.hpp"
#include "daemon/api/params.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

void describe_seq(Fields& fields, std::int64_t& seq, std::string_view meaning) {
  fields.integer64("seq", seq, {1, kLargestExactInteger}, meaning);
}

void ClientParam::describe(Fields& fields) {
  fields.text("client", client, kLongestClientName_bytes, "whose seq: 1 to 32 letters, digits, '.', '_', '-'");
}

const std::string& ClientParam::checked() const {
  if (!is_client_name(client)) {
    throw ProtocolError{json_rpc::kInvalidParams, "client must have 1 to 32 letters, digits, '.', '_' or '-'"};
  }
  return client;
}

void JobKeyParams::describe(Fields& fields) {
  fields.optional("job_id", job_id, [](Fields& inner, std::string& value) {
    inner.text("job_id", value, kMaxForeignText_bytes, "the job, by its id");
  });
  fields.optional("seq", seq, [](Fields& inner, std::int64_t& value) {
    describe_seq(inner, value, "or by its client's sequence number");
  });
}

JobKey JobKeyParams::key(const ClientParam& client) const {
  if (job_id.has_value() == seq.has_value()) {
    throw ProtocolError{json_rpc::kInvalidParams, "name the job by job_id or by seq, one of the two"};
  }
  const std::string& whose = client.checked();
  if (job_id) return *job_id;
  return ClientSeq{*seq, whose};
}

void JobStatusParams::describe(Fields& fields) {
  job.describe(fields);
  client.describe(fields);
  form.describe(fields, names_in<describe_job_status>());
}

void OneJobParams::describe(Fields& fields) {
  job.describe(fields);
  client.describe(fields);
}

}  // namespace fvd
