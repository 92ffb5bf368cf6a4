/// Every reply that a PLC polls, with every field at its limit: compact replies fit 440 bytes, full ones 1,400.

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "daemon/api/params.hpp"
#include "daemon/api/reply_form.hpp"
#include "tests/daemon/api/dispatcher_fixture.hpp"

namespace fvd {
namespace {

using nlohmann::json;

constexpr std::int64_t kGreatest = kLargestExactInteger;
/// More digits of a heartbeat than any daemon lives to show: it counts from the start of the test.
constexpr std::size_t kHeartbeatDigits = 10;

/// The greatest sizes so far, by the name of the bound.
struct Worst {
  std::size_t compact = 0;
  std::size_t full = 0;
  std::size_t replies = 0;
};

/// What comes from outside in its worst spellings: as it is, escaped, no ASCII, no characters at all, none that is
/// UTF-8.
std::vector<std::string> spellings(std::size_t bytes) {
  std::string umlauts;
  while (umlauts.size() + 2 <= bytes) umlauts += "\xc3\xa4";
  return {std::string(bytes, 'W'), std::string(bytes, '"'), umlauts, std::string(bytes, '\x01'),
          std::string(bytes, '\xff')};
}

/// Ids of 64 bytes as they are written, and the longest number.
std::vector<json> ids() { return {json(1), json(-kGreatest), json(std::string(64, 'i')), json(std::string(32, '"'))}; }

/// A result.json as long as they come: many measurements, warnings, figures of most digits.
std::string widest_result(bool has_evaluation, double number) {
  json values{{"height", {{"min_um", -number}, {"max_um", number}, {"mean_um", -number}, {"median_um", number}}},
              {"valid_fraction", 0.123456789}};
  json group = json::object();
  for (int i = 0; i < 20; ++i) group["some_figure_with_a_long_name_" + std::to_string(i)] = -number;
  json result{{"values", values},
              {"focus", group},
              {"frames", {{"expected", std::numeric_limits<int>::max()}, {"ok", std::numeric_limits<int>::max()}}},
              {"slices", group},
              {"steps", group},
              {"times", group},
              {"verdict", "uncertain"},
              {"source", group},
              {"evaluated", group},
              {"provenance", {{"simulated", false}}}};
  result["slices"]["suspect"] = json::array({group});
  result["focus"]["extra_peaks"] = json::array({group});
  result["warnings"] = json::array();
  for (int i = 0; i < 40; ++i) result["warnings"].push_back({{"code", "stage"}, {"text", std::string(300, '"')}});
  if (!has_evaluation) return result.dump();
  json measurements = json::object();
  json order = json::array();
  for (int i = 0; i < 50; ++i) {
    const std::string name = "measurement-" + std::to_string(i);
    order.push_back(name);
    measurements[name] = {{"id", "ABCD"},
                          {"main_value", "height_um"},
                          {"verdict", "uncertain"},
                          {"values", {{"height_um", {{"value", -number}, {"U", number}}}}}};
    if (i % 4 != 0) {
      measurements[name]["reason"] = "none";
      measurements[name]["reason_code"] = i % 4 == 1 ? 1122 : i % 4 == 2 ? 1141 : 1142;
    }
  }
  result["evaluation"] = {{"verdict", "uncertain"}, {"order", order}, {"measurements", measurements}};
  return result.dump();
}

class ReplySizes : public ADispatcher {
 protected:
  static void TearDownTestSuite() {
    std::printf("{\"worst_reply_bytes_compact\": %zu, \"worst_reply_bytes_full\": %zu, \"replies\": %zu}\n",
                worst().compact, worst().full, worst().replies);
  }
  static Worst& worst() {
    static Worst all;
    return all;
  }

  /// The reply to a request, which has at most so many bytes with its end of line; its result is as described.
  json checked(const json& id, const std::string& method, const json& params, std::size_t most) {
    Handled handled = dispatcher_.handle(
        json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump(), caller_);
    if (handled.waiting) handled.reply = dispatcher_.resume(*handled.waiting, true);
    std::size_t bytes = handled.reply.value().size() + 1;
    json answer = json::parse(*handled.reply, nullptr, false);
    EXPECT_FALSE(answer.is_discarded()) << *handled.reply;
    if (answer.contains("result") && answer["result"].contains("hb")) {
      bytes += kHeartbeatDigits - answer["result"]["hb"].dump().size();
    }
    EXPECT_LE(bytes, most) << method << " " << params.dump() << "\n" << *handled.reply;
    std::size_t& greatest = most == kCompactReply_bytes ? worst().compact : worst().full;
    greatest = std::max(greatest, bytes);
    ++worst().replies;
    EXPECT_EQ(answer["id"], id);
    expect_as_described({{"method", method}, {"params", params}}, answer);
    return answer;
  }

  /// A job whose every field is at its limit. text: what people are told.
  static JobStatus widest_job(const std::string& part_id, const std::string& text, ErrorCode error) {
    JobStatus job;
    job.job_id = std::string(64, 'J');
    job.request = {kGreatest, part_id, std::string(64, 'R'), std::string(32, 'C')};
    job.phase = "preparing";
    job.slices_done = std::numeric_limits<int>::max();
    job.slices_planned = std::numeric_limits<int>::max();
    job.frames.expected = std::numeric_limits<int>::max();
    job.frames.ok = std::numeric_limits<int>::max();
    job.error = error;
    job.error_message = text;
    job.not_durable = text;
    job.ended_utc = "1970-01-01T00:00:00.000Z";
    job.reason_codes = "1122,1141,1142,1145";
    job.verdict = "uncertain";
    return job;
  }
  MachineStatus widest_machine(const JobStatus& job, const std::string& text) {
    MachineStatus machine;
    machine.state = ScanState::kPreoperational;
    machine.recipe = std::string(64, 'R');
    machine.objective = std::string(64, '"');
    machine.job = job;
    machine.results_waiting = std::numeric_limits<int>::max();
    machine.epoch = kGreatest;
    machine.error = job.error;
    machine.error_message = text;
    machine.newest_seqs = std::make_shared<const NewestSeqs>(NewestSeqs{{job.request.client, kGreatest}});
    return machine;
  }
  /// Puts this job, in this state, in the place of all others.
  void hold(const JobStatus& job, JobState state, const std::string& text) {
    const JobRequest& request = job.request;
    service_.machine = widest_machine(job, text);
    service_.machine->job->state = state;
    if (service_.starts == 0) {
      service_.start(request);
    }
    service_.change({request.seq, request.client}, [&](JobStatus& held) {
      held = job;
      held.state = state;
    });
    service_.remaining = std::numeric_limits<int>::max();
    service_.result_dir = "/" + std::string(3000, 'd');
  }
  static json of_job() { return {{"seq", kGreatest}, {"client", std::string(32, 'C')}}; }
  static json with(json params, const char* key, const json& value) {
    params[key] = value;
    return params;
  }
  /// Asks all that a PLC polls of the held job.
  void poll(const json& id) {
    const json client{{"client", std::string(32, 'C')}};
    const json start{{"seq", kGreatest}, {"part_id", "p"}, {"client", std::string(32, 'C')}};
    checked(id, "system.ping", {{"t", std::string(62, 't')}}, kCompactReply_bytes);
    checked(id, "job.start", start, kCompactReply_bytes);
    checked(id, "job.latest", client, kCompactReply_bytes);
    checked(id, "result.next", json::object(), kCompactReply_bytes);
    checked(id, "result.ack", of_job(), kCompactReply_bytes);
    for (const auto& [format, most] :
         {std::pair{"compact", kCompactReply_bytes}, std::pair{"full", kFullReply_bytes}}) {
      const json state = checked(id, "system.state", with(client, "format", format), most);
      EXPECT_FALSE(state["result"].contains(kLeftOutKey)) << state;
      for (const char* method : {"job.status", "job.abort", "job.wait"}) {
        const json status = checked(id, method, with(of_job(), "format", format), most);
        EXPECT_FALSE(status["result"].contains(kLeftOutKey)) << status;
      }
      const json result = checked(id, "result.get", with(of_job(), "format", format), most);
      for (const char* key : {"seq", "part_id", "state", "error_code"}) {
        EXPECT_TRUE(result["result"].contains(key)) << key << " " << result;
      }
    }
  }
  /// Every error reply of these methods.
  void fail(const json& id, const std::string& text) {
    service_.machine->job.reset();  // the snapshot tells of no job
    for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i) {
      service_.failure = Error(static_cast<ErrorCode>(i), text);
      for (const char* method : {"job.status", "job.abort", "job.wait", "result.get", "result.ack"}) {
        const json error = checked(id, method, of_job(), kCompactReply_bytes)["error"];
        EXPECT_EQ(error["data"]["error"], error_name(static_cast<ErrorCode>(i)));
      }
      checked(id, "job.latest", json::object(), kCompactReply_bytes);
      checked(id, "result.next", json::object(), kCompactReply_bytes);
      checked(id, "job.start", {{"seq", 1}, {"part_id", "p"}}, kCompactReply_bytes);
    }
    service_.failure.reset();
  }
};

TEST_F(ReplySizes, FitWhateverNamesAndTextsAreInside) {
  for (const std::string& part_id : {std::string(64, 'p'), std::string(64, '"'), std::string("p")}) {
    for (const std::string& text : spellings(5000)) {
      for (const JobState state : {JobState::kProcessing, JobState::kFailed}) {
        hold(widest_job(part_id, text, ErrorCode::kCalibrationMissing), state, text);
        for (const json& id : ids()) poll(id);
      }
    }
  }
}

TEST_F(ReplySizes, FitWhateverFiguresAreInside) {
  for (const std::string& part_id : {std::string(64, 'p'), std::string(64, '"'), std::string("p")}) {
    const std::string text(300, '"');
    hold(widest_job(part_id, text, ErrorCode::kCalibrationMissing), JobState::kCompleted, text);
    for (const bool has_evaluation : {false, true}) {
      for (const double number : {1.0, 999999.12345678, std::numeric_limits<double>::max()}) {
        service_.result = widest_result(has_evaluation, number);
        for (const json& id : ids()) poll(id);
      }
    }
  }
}

TEST_F(ReplySizes, FitForErrorsOfEveryKind) {
  for (const std::string& text : spellings(5000)) {
    hold(widest_job("p", text, ErrorCode::kCalibrationMissing), JobState::kFailed, text);
    fail(ids().back(), text);
  }
}

TEST_F(ReplySizes, FitForRequestsThatAreWrong) {
  for (const std::string& text : spellings(2000)) {
    const std::string written = json(text).dump(-1, ' ', true, json::error_handler_t::replace);
    for (const std::string& line :
         {text, "{\"id\":" + written + "}", R"({"jsonrpc":"2.0","id":1,"method":)" + written + "}",
          R"({"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"part_id":)" + written +
              ",\"client\":" + written + "," + written + ":1}}",
          R"({"jsonrpc":"2.0","id":1,"method":"result.get","params":{"fields":[)" + written + "]}}"}) {
      const auto reply = dispatcher_.handle(line, caller_).reply;
      ASSERT_TRUE(reply.has_value()) << line;
      EXPECT_LE(reply->size() + 1, kCompactReply_bytes) << *reply;
      EXPECT_TRUE(json::accept(*reply)) << *reply;
      worst().compact = std::max(worst().compact, reply->size() + 1);
      ++worst().replies;
    }
  }
  for (const std::string& line : {Dispatcher::too_long(), Dispatcher::foreign_protocol(), Dispatcher::no_json(),
                                  Dispatcher::not_allowed_here(), Dispatcher::too_many_connections()}) {
    EXPECT_LE(line.size() + 1, kCompactReply_bytes) << line;
  }
}

TEST_F(ReplySizes, SayHowMuchWasLeftOut) {
  hold(widest_job(std::string(64, '"'), "disk", ErrorCode::kInternal), JobState::kCompleted, "");
  service_.result = widest_result(true, 1.5);
  const json worst_id = std::string(64, 'i');
  const json compact = checked(worst_id, "result.get", of_job(), kCompactReply_bytes)["result"];
  EXPECT_EQ(compact["m"].size() + compact["more"].get<std::size_t>(), 50U) << compact;
  EXPECT_EQ(compact.value(kLeftOutKey, 0), 2) << "job_id and age_s gave way: " << compact;
  for (const char* key : {"v", "c", "part_id", "warnings_count", "durable"}) EXPECT_TRUE(compact.contains(key)) << key;
  const json full = checked(1, "result.get", with(of_job(), "format", "full"), kFullReply_bytes)["result"];
  EXPECT_GT(full.value(kLeftOutKey, 0), 4) << full;
  EXPECT_EQ(full["warnings_count"], 40);
  const json roomy =
      checked(1, "result.get", json{{"seq", kGreatest}, {"client", std::string(32, 'C')}, {"fields", {"m"}}},
              kCompactReply_bytes)["result"];
  EXPECT_FALSE(roomy.contains(kLeftOutKey)) << roomy;
}

TEST_F(ReplySizes, HoldTheFieldsThatAreAskedForInTheirOrder) {
  hold(widest_job("p", "why", ErrorCode::kInternal), JobState::kCompleted, "why");
  const auto asked = [&](const std::string& method, json params, const std::vector<std::string>& fields) {
    params["fields"] = fields;
    const Handled handled =
        dispatcher_.handle(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump(), caller_);
    const auto reply =
        handled.waiting ? dispatcher_.resume(*handled.waiting, true).value_or("") : handled.reply.value_or("");
    std::vector<std::string> found;
    const auto answer = nlohmann::ordered_json::parse(reply);
    for (const auto& [key, value] : answer.at("result").items()) found.push_back(key);
    EXPECT_EQ(found, fields) << reply;
  };
  asked("system.state", json::object(), {"recipe", "ready", "error_message"});
  asked("job.status", of_job(), {"done", "job_id", "acquired"});
  asked("job.wait", of_job(), {"state", "acquired"});
  asked("job.abort", of_job(), {"state"});
  asked("result.get", of_job(), {"state", "seq", "valid_fraction"});
  asked("result.get", with(of_job(), "format", "full"), {"focus", "seq"});
}

TEST_F(ReplySizes, RefuseAFieldThatThereIsNotByItsName) {
  hold(widest_job("p", "", ErrorCode::kInternal), JobState::kCompleted, "");
  for (const char* method : {"system.state", "job.status", "job.wait", "job.abort", "result.get"}) {
    json params = method == std::string("system.state") ? json::object() : of_job();
    params["fields"] = {"state", "colour"};
    const json error = checked(1, method, params, kCompactReply_bytes)["error"];
    EXPECT_EQ(error["code"], -32602) << method;
    EXPECT_NE(error["message"].get<std::string>().find("colour"), std::string::npos) << error;
    EXPECT_NE(error["message"].get<std::string>().find("fields"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace fvd
