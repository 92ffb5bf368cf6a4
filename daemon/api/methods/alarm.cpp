/// Warnings and errors of the log that somebody has to see.

#include <string>

#include "daemon/api/list_shapes.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/jobs/alarm_log.hpp"

namespace fvd {

namespace {

struct AlarmParams {
  std::int64_t number = 1;
  std::string time_utc;

  void describe(Fields& fields) {
    fields.integer64("number", number, {1, kLargestExactInteger}, "of the alarm, as alarm.list tells it");
    fields.require("number");
    fields.text("time_utc", time_utc, kMaxForeignText_bytes,
                "its time_utc, as alarm.list tells it: another one is refused, for numbers begin anew with each start; "
                "empty = whichever has the number");
  }
};

void describe_alarms(Fields& fields) {
  ResultFields(fields).list(
      "alarms", static_cast<std::int64_t>(AlarmLog::kMostKept), describe_alarm,
      "the newest first; of more than 200 those go first that were acknowledged, then warnings, then errors; "
      "these, and those of before the daemon's start, are in the log");
}

void describe_acknowledged(Fields& fields) {
  ResultFields(fields).integer("acknowledged", kAnySeq, "number of the alarm; no other one is");
}

}  // namespace

void add_alarm_methods(MethodTable& methods, const Services& services) {
  methods["alarm.list"] = {
      .about = {.summary = "Warnings and errors of the log that somebody has to see, but for refused calls",
                .role = Role::kView,
                .params = described<NoParams>(),
                .result = describe_alarms},
      // 100 KiB of text: not on the network thread.
      .run = [&alarms = services.alarms](const Call&) -> Answer {
        return Reply{{"alarms", alarms_json(alarms.newest())}};
      }};
  methods["alarm.acknowledge"] = {
      .about = {.summary = "Says that somebody has seen an alarm; one that was acknowledged stays so",
                .role = Role::kOperate,
                .params = described<AlarmParams>(),
                .result = describe_acknowledged,
                .errors = {ErrorCode::kBadInput},
                .is_audited = true},
      .run = with<AlarmParams>([&alarms = services.alarms](const Call&, const AlarmParams& params) -> Answer {
        alarms.acknowledge(params.number, params.time_utc);
        return Reply{{"acknowledged", params.number}};
      })};
}

}  // namespace fvd
