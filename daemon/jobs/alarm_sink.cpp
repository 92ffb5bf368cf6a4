#include "daemon/jobs/alarm_sink.hpp"

#include <string_view>
#include <utility>

#include <spdlog/sinks/sink.h>

#include "daemon/access/refused_calls.hpp"

namespace fvd {

namespace {

AlarmLevel alarm_level(spdlog::level::level_enum level) {
  if (level >= spdlog::level::critical) return AlarmLevel::kCritical;
  return level == spdlog::level::err ? AlarmLevel::kError : AlarmLevel::kWarning;
}

/// The logger asks for the level before it logs.
class AlarmSink final : public spdlog::sinks::sink {
 public:
  explicit AlarmSink(std::shared_ptr<AlarmLog> alarms) : alarms_(std::move(alarms)) { set_level(spdlog::level::warn); }
  void log(const spdlog::details::log_msg& message) override {
    if (std::string_view(message.logger_name.data(), message.logger_name.size()) == RefusedCalls::kLogger) return;
    alarms_->note(alarm_level(message.level), {message.payload.data(), message.payload.size()}, message.time);
  }
  void flush() override {}
  void set_pattern(const std::string& /*pattern*/) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

 private:
  const std::shared_ptr<AlarmLog> alarms_;
};

}  // namespace

spdlog::sink_ptr alarm_sink(std::shared_ptr<AlarmLog> alarms) { return std::make_shared<AlarmSink>(std::move(alarms)); }

}  // namespace fvd
