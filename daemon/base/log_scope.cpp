#include "daemon/base/log_scope.hpp"

namespace fvd {

namespace {

thread_local const LogScope* innermost = nullptr;

}  // namespace

LogScope::LogScope(LogFields fields) : fields_(std::move(fields)), outer_(innermost) { innermost = this; }

LogScope::~LogScope() { innermost = outer_; }

std::vector<std::string> LogScope::fields() {
  LogFields all;
  const auto take = [](std::string& value, const std::string& outer) {
    if (value.empty()) value = outer;
  };
  for (const LogScope* scope = innermost; scope != nullptr; scope = scope->outer_) {
    take(all.job_id, scope->fields_.job_id);
    take(all.part_id, scope->fields_.part_id);
    take(all.caller, scope->fields_.caller);
  }
  std::vector<std::string> texts;
  if (!all.job_id.empty()) texts.push_back("FVD_JOB_ID=" + all.job_id);
  if (!all.part_id.empty()) texts.push_back("FVD_PART_ID=" + all.part_id);
  if (!all.caller.empty()) texts.push_back("FVD_CALLER=" + all.caller);
  return texts;
}

}  // namespace fvd
