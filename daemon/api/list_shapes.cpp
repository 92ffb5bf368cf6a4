#include "daemon/api/list_shapes.hpp"

#include <string>

#include "daemon/api/json_shapes.hpp"
#include "daemon/jobs/alarm_log.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

ordered_json verdict_json(const std::string& verdict) {
  return verdict.empty() ? ordered_json(nullptr) : ordered_json(verdict);
}

ordered_json number_or_null(const std::optional<double>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

}  // namespace

void describe_job_row(const ResultFields& row) {
  row.text("job_id", 64, "the job's id");
  row.integer("seq", kAnySeq, "its client's number");
  row.text("client", 32, "whose seq");
  row.text("part_id", 64, "as given");
  row.text("recipe", 64, "recipe id");
  row.choice("state", kJobStates, "how far the job is, and how it ended");
  row.choice_or_null("verdict", kVerdicts, "on the part; null = nothing was judged");
  row.text("ended_utc", 24, "when it ended; empty = it has not");
  row.text("error", 64, "name of the error by which it failed or was aborted; empty = no error");
}

ordered_json job_row_json(const JobStatus& job) {
  return {{"job_id", job.job_id},
          {"seq", job.request.seq},
          {"client", job.request.client},
          {"part_id", job.request.part_id},
          {"recipe", job.request.recipe},
          {"state", job_state_name(job.state)},
          {"verdict", verdict_json(job.verdict)},
          {"ended_utc", job.ended_utc},
          {"error", error_of(job.error)}};
}

void describe_value_point(const ResultFields& point) {
  point.text("job_id", 64, "the job's id");
  point.text("part_id", 64, "of the job");
  point.text("ended_utc", 24, "when the job ended");
  point.number_or_null("value", "in the unit that its name or the job's result tells; null = it could not be given");
  point.number_or_null("u", "standard uncertainty, in the same unit; null = not known");
  point.number_or_null("U", "expanded uncertainty k u, 95 %; null = not known");
  point.number_or_null("lower", "limit that the job was judged by; null = none");
  point.number_or_null("upper", "likewise");
  point.choice_or_null("verdict", kVerdicts, "on the value; null = nothing was judged");
}

ordered_json value_point_json(const ValuePoint& point) {
  return {{"job_id", point.job_id},
          {"part_id", point.part_id},
          {"ended_utc", point.ended_utc},
          {"value", number_or_null(point.value.value)},
          {"u", number_or_null(point.value.u)},
          {"U", number_or_null(point.value.expanded_u)},
          {"lower", number_or_null(point.value.lower)},
          {"upper", number_or_null(point.value.upper)},
          {"verdict", verdict_json(point.value.verdict)}};
}

void describe_alarm(const ResultFields& alarm) {
  alarm.integer("number", kAnySeq, "counts the alarms since the daemon's start, from 1");
  alarm.text("time_utc", 24, "when it was told first");
  alarm.text("last_utc", 24, "when it was told last");
  alarm.choice("level", {"warning", "error", "critical"}, "of the line of the log");
  alarm.text("text", AlarmLog::kLongestText_bytes, "of the line, for people");
  alarm.integer("count", kAnySeq, "so often: a line that comes again within a minute is counted");
  alarm.boolean("acknowledged", "by alarm.acknowledge");
}

ordered_json alarms_json(const std::vector<Alarm>& alarms) {
  ordered_json list = ordered_json::array();
  for (const Alarm& alarm : alarms) {
    list.push_back({{"number", alarm.number},
                    {"time_utc", alarm.time_utc},
                    {"last_utc", alarm.last_utc},
                    {"level", alarm_level_name(alarm.level)},
                    {"text", alarm.text},
                    {"count", alarm.count},
                    {"acknowledged", alarm.acknowledged}});
  }
  return list;
}

}  // namespace fvd
