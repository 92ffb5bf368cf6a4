/// Logging in, control, stops that wait for nothing, and what is written down of it.

#include <algorithm>
#include <optional>

#include "daemon/access/token_file.hpp"
#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

std::string call(const std::string& method, const json& params = json::object()) {
  return json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
}

class AnInstrumentWithSeveralCallers : public ADispatcher {
 protected:
  json answer_to(const Caller& caller, const std::string& line) {
    return json::parse(dispatcher_.handle(line, caller).reply.value());
  }
  int code_of(const Caller& caller, const std::string& line) {
    return answer_to(caller, line).value("/error/code"_json_pointer, 0);
  }

  /// The answer to a line that stands behind another.
  std::optional<Handled> overtaken(const std::string& line, const Caller& caller, Dispatcher::Behind behind) {
    const Method* method = dispatcher_.overtaker(line);
    if (method == nullptr || !Dispatcher::may_overtake(*method, caller, behind)) return std::nullopt;
    return dispatcher_.try_handle(line, caller);
  }

  const Caller plc_{.connection = 1, .peer = "10.0.0.7:4000", .who = {"address 10.0.0.7", Role::kOperate}};
  const Caller page_{.connection = 2, .who = {"token page", Role::kSetUp}};
  const std::string start_ = call("job.start", {{"seq", 1}, {"part_id", "p"}});
};

TEST_F(AnInstrumentWithSeveralCallers, ObeysOnlyWhoHasControl) {
  EXPECT_EQ(answer_to(plc_, call("control.acquire", {{"owner", "line-2"}}))["result"]["yours"], true);
  const json state = answer_to(page_, call("control.state"))["result"];
  EXPECT_EQ(state["owner"], "line-2");
  EXPECT_EQ(state["yours"], false);
  for (const std::string& line :
       {start_, call("recipe.prepare", {{"id", "chapter"}}), call("stage.move", {{"z_um", 1}}), call("stage.home"),
        call("objective.confirm", {{"name", "20x"}}), call("stage.autofocus", {{"from_um", 0}, {"to_um", 10}}),
        call("stage.jog", {{"direction", "up"}, {"speed_um_per_s", 1}})}) {
    EXPECT_EQ(code_of(page_, line), 1003) << line;
  }
  EXPECT_EQ(service_.starts, 0);
  EXPECT_TRUE(service_.motions.empty());
  EXPECT_EQ(code_of(page_, call("system.state")), 0);
  EXPECT_EQ(code_of(page_, call("stage.stop")), 0) << "a stop needs no control";
  EXPECT_EQ(code_of(page_, call("control.acquire", {{"owner", "page"}})), 1003);
  EXPECT_EQ(code_of(page_, call("control.acquire", {{"owner", "page"}, {"force", true}})), 1004);
  EXPECT_EQ(code_of(plc_, start_), 0);
  EXPECT_EQ(answer_to(page_, call("control.release"))["result"]["owner"], "line-2") << "it is not its own";
  EXPECT_EQ(answer_to(plc_, call("control.release"))["result"]["owner"], "");
  EXPECT_EQ(code_of(page_, call("recipe.prepare", {{"id", "chapter"}})), 0);
}

TEST_F(AnInstrumentWithSeveralCallers, GivesControlToForceOnlyBetweenJobs) {
  answer_to(plc_, call("control.acquire", {{"owner", "plc"}}));
  const std::string take = call("control.acquire", {{"owner", "anna"}, {"force", true}});
  service_.job_runs = true;
  EXPECT_EQ(code_of(caller_, take), 1002);
  service_.job_runs = false;
  EXPECT_EQ(answer_to(caller_, take)["result"]["owner"], "anna");
  EXPECT_EQ(code_of(plc_, start_), 1003);
  for (const json& params : {json{{"owner", ""}}, json{{"owner", "a b"}}, json{{"owner", "a"}, {"lease_s", 0}},
                             json{{"owner", "a"}, {"lease_s", 3601}}, json::object()}) {
    EXPECT_EQ(code_of(caller_, call("control.acquire", params)), -32602) << params;
  }
}

TEST_F(AnInstrumentWithSeveralCallers, TellsWhetherStandstillIsKnownAfterAStop) {
  EXPECT_EQ(answer_to(plc_, call("stage.stop"))["result"], (json{{"stopped", "command"}, {"standstill", true}}));
  service_.unseen_looks = 2;  // it moves since the last look at the devices
  EXPECT_EQ(answer_to(plc_, call("stage.stop"))["result"]["standstill"], false);
  EXPECT_EQ(answer_to(page_, call("system.health"))["result"]["stage"]["standstill"], false);
  EXPECT_EQ(answer_to(page_, call("system.health"))["result"]["stage"]["standstill"], true);
  service_.machine.emplace();  // of a stage that was lost in motion nothing is known
  EXPECT_EQ(answer_to(plc_, call("stage.stop"))["result"]["standstill"], false);
}

TEST_F(AnInstrumentWithSeveralCallers, TellsWhereTheStageIsWhereThatIsKnown) {
  EXPECT_FALSE(answer_to(page_, call("system.health"))["result"]["stage"].contains("z_um"));
  service_.machine.emplace().health.position = Micrometers{-12.5};
  EXPECT_EQ(answer_to(page_, call("system.health"))["result"]["stage"]["z_um"], -12.5);
}

TEST_F(AnInstrumentWithSeveralCallers, TellsHowFarTheStageMayBeSentWhileItIsOpen) {
  EXPECT_FALSE(answer_to(page_, call("system.health"))["result"]["stage"].contains("min_um"));
  service_.machine.emplace().health.reach = StageReach{Micrometers{-3000.0}, Micrometers{12000.5}};
  const json stage = answer_to(page_, call("system.health"))["result"]["stage"];
  EXPECT_EQ(stage["min_um"], -3000.0);
  EXPECT_EQ(stage["max_um"], 12000.5);
}

TEST_F(AnInstrumentWithSeveralCallers, StopsWithoutAWorker) {
  service_.current = JobStatus{};
  service_.current->job_id = "J1";
  for (const std::string& line : {call("stage.stop"), call("job.abort", {{"job_id", "J1"}})}) {
    const auto handled = overtaken(line, plc_, Dispatcher::Behind::kWork);
    ASSERT_TRUE(handled) << line;
    EXPECT_TRUE(json::parse(handled->reply.value()).contains("result")) << *handled->reply;
  }
  EXPECT_EQ(service_.stops, 1);
  EXPECT_EQ(service_.aborts, 1);
  EXPECT_FALSE(overtaken(call("job.abort", {{"job_id", "J0"}}), plc_, Dispatcher::Behind::kWork))
      << "it waits for its turn";
  for (const std::string& line : {call("system.ping"), start_, std::string("[") + call("stage.stop") + "]",
                                  std::string("{\"method\": 1}"), std::string("nonsense"), std::string("7")}) {
    EXPECT_FALSE(overtaken(line, plc_, Dispatcher::Behind::kWork)) << line;
  }
  EXPECT_TRUE(overtaken(call("system.ping"), plc_, Dispatcher::Behind::kWait));
  EXPECT_FALSE(overtaken(start_, plc_, Dispatcher::Behind::kWait));
  EXPECT_EQ(code_of({.who = {"viewer", Role::kView}}, call("stage.stop")), 1004);
  EXPECT_FALSE(overtaken(call("stage.stop"), {.who = {"viewer", Role::kView}}, Dispatcher::Behind::kWork))
      << "a log-in before it may give it the role";
  const json batch = answer_to(plc_, "[" + call("system.ping") + "," + call("stage.stop") + "]");
  EXPECT_EQ(batch[1]["error"]["code"], -32600) << "nothing is to hold it back, and nothing to do it twice";
  EXPECT_EQ(service_.stops, 1);
}

TEST_F(AnInstrumentWithSeveralCallers, MovesNothingThatWasAskedForBeforeAStop) {
  Caller early = page_;
  early.received = HostClock::now();
  answer_to(plc_, call("stage.stop"));
  for (const std::string& line : {start_, call("stage.move", {{"z_um", 1}})}) EXPECT_EQ(code_of(early, line), 1012);
  EXPECT_EQ(service_.starts, 0);
  EXPECT_TRUE(service_.motions.empty());
  early.received = HostClock::now();
  EXPECT_EQ(code_of(early, start_), 0);
}

TEST_F(AnInstrumentWithSeveralCallers, JogsAsLongAsItIsAskedTo) {
  Caller page = page_;
  page.received = HostClock::now();
  const std::string jog = call("stage.jog", {{"direction", "down"}, {"speed_um_per_s", 50}, {"until_ms", 100}});
  EXPECT_FALSE(dispatcher_.try_handle(jog, page)) << "it begins on the worker";
  EXPECT_EQ(answer_to(page, jog)["result"]["begins"], true);
  EXPECT_EQ(service_.jogs.back().until, page.received + std::chrono::milliseconds(100));
  EXPECT_FALSE(service_.jogs.back().up);
  page.received += std::chrono::milliseconds(80);
  EXPECT_EQ(json::parse(dispatcher_.try_handle(jog, page).value().reply.value())["result"]["begins"], false);
  for (const json& params :
       {json{{"direction", "left"}, {"speed_um_per_s", 1}}, json{{"direction", "up"}},
        json{{"direction", "up"}, {"speed_um_per_s", 0}}, json{{"direction", "up"}, {"speed_um_per_s", -1}},
        json{{"direction", "up"}, {"speed_um_per_s", 1}, {"until_ms", 151}}, json{{"speed_um_per_s", 1}}}) {
    EXPECT_EQ(code_of(page, call("stage.jog", params)), -32602) << params;
  }
  EXPECT_EQ(service_.jogs.size(), 2U);
}

TEST_F(AnInstrumentWithSeveralCallers, WritesDownHowItEndedWhereTheReplyComesLater) {
  Caller page = page_;
  page.received = HostClock::now();
  (void)dispatcher_.handle(call("stage.move", {{"z_um", 1}}), page);
  ASSERT_TRUE(service_.task);
  json entries = answer_to(page_, call("audit.list"))["result"]["entries"];
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0]["outcome"], "accepted") << "nobody knows yet how it ends";

  service_.task->fail(ErrorCode::kStageAlarm, "the drive has an alarm");
  entries = answer_to(page_, call("audit.list"))["result"]["entries"];
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0]["what"], "stage.move");
  EXPECT_EQ(entries[0]["who"], "token page");
  EXPECT_EQ(entries[0]["outcome"], "stage_alarm");
}

TEST_F(AnInstrumentWithSeveralCallers, WritesDownWhoAskedForWhat) {
  answer_to(plc_, start_);
  answer_to(page_, call("recipe.save", {{"id", "c"}, {"text", "{}"}, {"base_version", 1}, {"author", "anna"}}));
  answer_to(page_, call("stage.stop"));
  answer_to(page_, call("system.state"));
  answer_to({.who = {"viewer", Role::kView}}, start_);
  service_.control.acquire({plc_.who, "plc", std::chrono::seconds(60)});
  answer_to(page_, call("stage.move", {{"z_um", 1}}));
  const json entries = answer_to(page_, call("audit.list"))["result"]["entries"];
  ASSERT_EQ(entries.size(), 5U) << "looks are no rows: " << entries;
  EXPECT_EQ(entries[0]["outcome"], "no_control");
  EXPECT_EQ(entries[1]["who"], "viewer");
  EXPECT_EQ(entries[1]["outcome"], "not_allowed");
  EXPECT_EQ(entries[4]["what"], "job.start");
  EXPECT_EQ(entries[4]["who"], "address 10.0.0.7");
  EXPECT_EQ(entries[4]["role"], "operate");
  EXPECT_EQ(entries[4]["peer"], "10.0.0.7:4000");
  EXPECT_EQ(entries[4]["client"], "plc");
  EXPECT_EQ(entries[4]["outcome"], "ok");
  EXPECT_NE(entries[4]["detail"].get<std::string>().find("\"part_id\":\"p\""), std::string::npos);
  EXPECT_EQ(entries[3]["what"], "recipe.save");
  EXPECT_EQ(entries[3]["outcome"], "recipe_conflict");
  EXPECT_EQ(entries[3]["detail"].get<std::string>().find("{}"), std::string::npos) << "no documents";
  EXPECT_EQ(entries[2]["what"], "stage.stop");
  const json older = answer_to(page_, call("audit.list", {{"most", 1}, {"before", 3}}))["result"]["entries"];
  ASSERT_EQ(older.size(), 1U);
  EXPECT_EQ(older[0]["what"], "recipe.save");
}

class ALogIn : public testing::Test {
 protected:
  ALogIn() {
    service_.access_config.token_file = folder_ / "tokens";
    test::write_text(folder_ / "tokens", credential_of("kiosk", Role::kOperate, token_).line());
  }

  test::ScratchDir folder_;
  const std::string token_ = new_token();
  FakeJobService service_;
  const Caller nobody_{.who = {"address 10.0.0.9", Role::kNone}};
};

TEST_F(ALogIn, MakesTheCallerTheTokensHolder) {
  const Dispatcher dispatcher(all_methods(service_.services()), service_.services());
  const Handled handled = dispatcher.handle(call("session.login", {{"token", token_}}), nobody_);
  EXPECT_EQ(handled.log_in, (Identity{"token kiosk", Role::kOperate}));
  EXPECT_TRUE(handled.is_accepted);
  EXPECT_EQ(json::parse(handled.reply.value())["result"], (json{{"who", "token kiosk"}, {"role", "operate"}}));
  EXPECT_EQ(handled.reply->find(token_), std::string::npos);
}

TEST_F(ALogIn, IsRefusedToEverybodyElseAndSaysNothingOfTokens) {
  const Dispatcher dispatcher(all_methods(service_.services()), service_.services());
  const std::string good = call("session.login", {{"token", token_}});
  const std::string notification =
      json{{"jsonrpc", "2.0"}, {"method", "session.login"}, {"params", {{"token", token_}}}}.dump();
  for (const std::string& line :
       {call("session.login", {{"token", new_token()}}), call("session.login", {{"token", ""}}), call("session.login"),
        call("session.login", {{"token", std::string(300, 'a')}}), "[" + good + "]", notification, call("system.state"),
        call("session.info")}) {
    const Handled handled = dispatcher.handle(line, nobody_);
    EXPECT_FALSE(handled.log_in) << line;
    EXPECT_FALSE(handled.is_accepted) << line;
    EXPECT_EQ(handled.reply.value_or("").find("fvd-"), std::string::npos) << *handled.reply;
  }
  test::write_text(folder_ / "tokens", "nonsense");
  const auto reply = json::parse(dispatcher.handle(good, nobody_).reply.value());
  EXPECT_EQ(reply["error"]["code"], 1015) << reply;
  const std::string message = reply["error"]["message"];
  EXPECT_NE(message.find("log"), std::string::npos) << message;
  for (const char* detail : {"nonsense", "line 1", "/"}) {
    EXPECT_EQ(message.find(detail), std::string::npos) << "no stranger's business: " << message;
  }
}

}  // namespace
}  // namespace fvd
