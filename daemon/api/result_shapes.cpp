#include "daemon/api/result_shapes.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "daemon/api/compact_evaluation.hpp"
#include "daemon/api/json_shapes.hpp"
#include "daemon/api/result_fields.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;

/// What a full result repeats of result.json.
constexpr std::array kFullGroups{"values", "focus", "frames", "slices", "steps", "times"};
/// Of formats 2 and later; the last two only of results that were evaluated anew.
constexpr std::array kFullLists{"verdict", "warnings", "evaluated", "source"};

constexpr std::array<std::string_view, 8> kCompactGiveWay{
    "client", "job_id", "frames_expected", "frames_ok", "height_mean_um", "height_max_um", "height_min_um", "age_s"};
constexpr std::array<std::string_view, 11> kFullGiveWay{"focus",         "steps",     "times",  "slices",
                                                        "frames",        "warnings",  "source", "evaluated",
                                                        "error_message", "directory", "values"};

void describe_compact(Fields& fields, Presence presence) {
  const ResultFields result(fields);
  constexpr auto kSometimes = Presence::kSometimes;
  result.text("job_id", 64, "the job's id; in compact as far as it fits", kSometimes);
  result.integer("seq", kAnySeq, "its client's number", presence);
  result.text("client", 32, "whose seq; in compact as far as it fits, and not with an evaluation", kSometimes);
  result.text("part_id", 64, "as given", presence);
  result.choice("state", kJobStates, "how the job ended; processing while there is no result", presence);
  result.integer("error_code", kAnyErrorCode, "0 = no error", presence);
  result.number("valid_fraction", {0.0, 1.0}, "of the points", kSometimes);
  result.number("height_min_um", "of the valid points", kSometimes);
  result.number("height_max_um", "of the valid points", kSometimes);
  result.number("height_mean_um", "of the valid points", kSometimes);
  result.integer("frames_expected", kAnyCount, "compact: repeated ones too", kSometimes);
  result.integer("frames_ok", kAnyCount, "compact", kSometimes);
  result.boolean("simulated", "a device was simulated", kSometimes);
  result.integer("warnings_count", kAnyCount, "what lowers trust; the full result says what", kSometimes);
  describe_compact_evaluation(fields);
  result.integer("age_s", kAnySeq, "since the job ended", kSometimes);
  result.text("ended_utc", 24, "full, complete: when the job ended", kSometimes);
  result.boolean("durable", "false while the end is not stored yet: job.status tells why", kSometimes);
  describe_left_out(result);
}

ordered_json identity_of(const JobStatus& job) {
  return {{"job_id", job.job_id},
          {"seq", job.request.seq},
          {"client", job.request.client},
          {"part_id", job.request.part_id}};
}

void note_end(const JobStatus& job, ordered_json& json) {
  if (!job.not_durable.empty()) json["durable"] = false;
  if (job.ended_utc.empty()) return;
  json["ended_utc"] = job.ended_utc;
  json["age_s"] = seconds_since(job.ended_utc);
}

ordered_json rounded(const ordered_json& value) { return rounded_figure(value.get<double>()); }

/// room: bytes that it may have.
ordered_json compact_json(const StoredJob& stored, std::size_t room) {
  const JobStatus& job = stored.status;
  ordered_json json = identity_of(job);
  json["state"] = job_state_name(job.state);
  json["error_code"] = code_of(job.error);
  note_end(job, json);
  json.erase("ended_utc");
  if (stored.result_json.empty()) return json;
  const auto result = ordered_json::parse(stored.result_json);
  if (result.contains("evaluation")) {
    json.erase("client");  // who asks knows whose number it is; its bytes hold a value
    json["warnings_count"] = result["warnings"].size();
    json["simulated"] = result.at("provenance").at("simulated");
    add_compact_evaluation(result["evaluation"], room, json);
    return json;
  }
  const auto& values = result.at("values");
  json["valid_fraction"] = rounded(values.at("valid_fraction"));
  for (const char* key : {"min_um", "max_um", "mean_um"}) {
    const auto& value = values.at("height").at(key);
    if (!value.is_null()) json[std::string("height_") + key] = rounded(value);
  }
  json["frames_expected"] = result.at("frames").at("expected");
  json["frames_ok"] = result.at("frames").at("ok");
  json["warnings_count"] = result.contains("warnings") ? result["warnings"].size() : 0;
  json["simulated"] = result.at("provenance").at("simulated");
  return json;
}

ordered_json complete_json(const StoredJob& stored) {
  const JobStatus& job = stored.status;
  ordered_json json = identity_of(job);
  json["state"] = job_state_name(job.state);
  json["error_code"] = code_of(job.error);
  json["directory"] = stored.result_dir;
  note_end(job, json);
  if (!stored.result_json.empty()) json["result"] = ordered_json::parse(stored.result_json);
  return json;
}

ordered_json full_json(const StoredJob& stored) {
  const JobStatus& job = stored.status;
  ordered_json json = identity_of(job);
  json["recipe"] = job.request.recipe;
  json["state"] = job_state_name(job.state);
  json["error_code"] = code_of(job.error);
  json["error"] = error_of(job.error);
  json["error_message"] = cut_text(job.error_message, kLongestMessage_bytes);
  note_end(job, json);
  json["directory"] = stored.result_dir;
  if (stored.result_json.empty()) return json;
  const auto result = ordered_json::parse(stored.result_json);
  json["simulated"] = result.at("provenance").at("simulated");
  if (result.contains("warnings")) json["warnings_count"] = result["warnings"].size();
  for (const char* key : kFullGroups) json[key] = result.at(key);
  for (const char* key : kFullLists) {
    if (result.contains(key)) json[key] = result[key];
  }
  // Per estimator figures and the list of files stand in the directory's result.json.
  json["focus"].erase("extra_peaks");
  // A flag instead of the list: how many frames must not be believed; warnings say which.
  auto& slices = json["slices"];
  if (slices.contains("suspect")) slices["suspect_count"] = slices["suspect"].size();
  slices.erase("suspect");
  return json;
}

}  // namespace

void describe_next_result(Fields& fields) { describe_compact(fields, Presence::kSometimes); }

void describe_result(Fields& fields) {
  describe_compact(fields, Presence::kAlways);
  const ResultFields result(fields);
  constexpr auto kSometimes = Presence::kSometimes;
  result.any("result", "complete: result.json", kSometimes);
  result.text("recipe", 64, "full: recipe id", kSometimes);
  result.text("error", 64, "full: the error's name", kSometimes);
  result.text("error_message", kLongestMessage_bytes, "full: for people", kSometimes);
  result.text("directory", "full, complete: where the files are", kSometimes);
  for (const char* group : kFullGroups) result.any(group, "full: as in result.json, as far as it fits", kSometimes);
  for (const char* list : kFullLists) result.any(list, "full: as in result.json, as far as it fits", kSometimes);
}

ordered_json result_reply(const StoredJob& stored, const ReplyForm& form, std::size_t envelope_bytes) {
  const std::size_t most = longest_reply_bytes(form.format);
  const std::size_t room = most - std::min(most, envelope_bytes);
  ordered_json json = form.format == ReplyFormat::kCompact ? compact_json(stored, room)
                      : form.format == ReplyFormat::kFull  ? full_json(stored)
                                                           : complete_json(stored);
  if (!form.fields.empty()) json = picked(json, form.fields);
  if (form.format == ReplyFormat::kCompact) fit(json, room, kCompactGiveWay);
  if (form.format == ReplyFormat::kFull) fit(json, room, kFullGiveWay);
  return json;
}

}  // namespace fvd
