#include "daemon/api/reply_size.hpp"

#include <utility>

#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json too_large(const ordered_json& reply, std::size_t bytes, std::size_t most_bytes) {
  const ordered_json id = reply.value("id", ordered_json(nullptr));
  return failure_reply(nlohmann::json::parse(id.dump()), json_rpc::kInvalidParams,
                       "the answer has " + std::to_string(bytes) + " bytes, more than the " +
                           std::to_string(most_bytes) +
                           " that a connection takes: ask for less of it (most, format, fields, a shorter line of a "
                           "profile, fewer requests in a batch), or by HTTP");
}

}  // namespace

std::string line_within(ordered_json reply, std::size_t most_bytes) {
  std::string line = reply_line(reply);
  if (line.size() <= most_bytes) return line;
  if (!reply.is_array()) return reply_line(too_large(reply, line.size(), most_bytes));
  std::size_t sum = 0;
  for (ordered_json& each : reply) {
    const std::size_t bytes = reply_line(each).size() + 1;
    if (sum + bytes > most_bytes) {
      each = too_large(each, bytes, most_bytes);
    } else {
      sum += bytes;
    }
  }
  return reply_line(reply);
}

}  // namespace fvd
