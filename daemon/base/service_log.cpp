#include "daemon/base/service_log.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <spdlog/sinks/base_sink-inl.h>  // the template for a mutex of our own
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <systemd/sd-journal.h>
#include <unistd.h>

#include "core/base/mutex.hpp"
#include "daemon/base/log_scope.hpp"

namespace fvd {

namespace {

int syslog_priority(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::critical:
      return 2;
    case spdlog::level::err:
      return 3;
    case spdlog::level::warn:
      return 4;
    case spdlog::level::info:
      return 6;
    default:
      return 7;
  }
}

/// The logger is synchronous, so the thread that logs is the one whose scopes are asked.
class JournalSink final : public spdlog::sinks::base_sink<Mutex> {
 public:
  explicit JournalSink(JournalEntry deliver) : deliver_(std::move(deliver)) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text(message.payload.data(), message.payload.size());
    const std::string priority = std::to_string(syslog_priority(message.level));
    std::vector<std::string> entry = LogScope::fields();
    entry.push_back("PRIORITY=" + priority);
    entry.push_back("SYSLOG_IDENTIFIER=fvd");
    entry.push_back("MESSAGE=" + text);
    if (!deliver_(entry)) std::fprintf(stderr, "<%s>%s\n", priority.c_str(), text.c_str());
  }
  void flush_() override {}

 private:
  const JournalEntry deliver_;
};

bool send_to_journal(const std::vector<std::string>& entry) {
  std::vector<iovec> parts;
  parts.reserve(entry.size());
  // The journal's interface is that of writev(): it changes nothing.
  for (const std::string& field : entry) parts.push_back({const_cast<char*>(field.data()), field.size()});
  return sd_journal_sendv(parts.data(), static_cast<int>(parts.size())) >= 0;
}

bool stderr_is_the_journal() {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat status {};
  if (stream == nullptr || ::fstat(STDERR_FILENO, &status) != 0) return false;
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino) == stream;
}

}  // namespace

std::shared_ptr<spdlog::logger> journal_logger(JournalEntry deliver) {
  return std::make_shared<spdlog::logger>("fvd", std::make_shared<JournalSink>(std::move(deliver)));
}

void set_up_service_log(spdlog::sink_ptr warnings) {
  auto logger = stderr_is_the_journal() ? journal_logger(send_to_journal) : spdlog::stderr_color_mt("fvd");
  if (warnings) logger->sinks().push_back(std::move(warnings));
  spdlog::set_default_logger(std::move(logger));
}

void set_log_level(spdlog::level::level_enum level) {
  const auto logger = spdlog::default_logger();
  if (!logger->sinks().empty()) logger->sinks().front()->set_level(level);
  logger->set_level(std::min(level, spdlog::level::warn));
}

}  // namespace fvd
