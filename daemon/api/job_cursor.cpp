#include "daemon/api/job_cursor.hpp"

#include <charconv>
#include <string_view>
#include <system_error>

#include "daemon/api/replies.hpp"
#include "daemon/api/rpc_errors.hpp"

namespace fvd {

namespace {

/// Says what it is of, and which form it has, should there be another one.
constexpr std::string_view kBegin = "job-before-";

}  // namespace

std::string job_cursor(std::int64_t next) {
  return next == 0 ? std::string() : std::string(kBegin) + std::to_string(next);
}

std::int64_t before_of_cursor(const std::string& cursor) {
  if (cursor.empty()) return 0;
  std::int64_t before = 0;
  if (cursor.starts_with(kBegin)) {
    const char* const end = cursor.data() + cursor.size();
    const auto read = std::from_chars(cursor.data() + kBegin.size(), end, before);
    if (read.ec != std::errc{} || read.ptr != end || before <= 0) before = 0;
  }
  if (job_cursor(before) == cursor) return before;
  throw ProtocolError{json_rpc::kInvalidParams,
                      "before: " + quoted(cursor) +
                          " is no cursor of this list: give the `next` of an answer of job.list as it came, or leave "
                          "before out for the newest jobs"};
}

}  // namespace fvd
