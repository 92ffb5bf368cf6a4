#pragma once

/// What the log lines of a thread are about, as fields of the journal beside the text.

#include <string>
#include <utility>
#include <vector>

namespace fvd {

struct LogFields {
  std::string job_id{};   ///< FVD_JOB_ID
  std::string part_id{};  ///< FVD_PART_ID
  std::string caller{};   ///< FVD_CALLER: the client's name
};

/// Lines that this thread logs while the object lives carry its fields; those of an inner scope go before those of an
/// outer one. context: the thread that makes it; scopes end in the reverse order of their begin.
class LogScope {
 public:
  explicit LogScope(LogFields fields);
  ~LogScope();
  LogScope(const LogScope&) = delete;
  LogScope& operator=(const LogScope&) = delete;

  /// Of all scopes of this thread, as "FVD_JOB_ID=...", only fields that are not empty.
  [[nodiscard]] static std::vector<std::string> fields();

 private:
  const LogFields fields_;
  const LogScope* const outer_;
};

}  // namespace fvd
