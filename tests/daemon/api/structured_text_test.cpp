/// The loop in structured text, run against a dispatcher: cycles, parts that come and go, lost replies, lost power.

#include "tests/daemon/api/structured_text.hpp"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/daemon/api/dispatcher_fixture.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

using nlohmann::json;

/// Many controllers' strings end there.
constexpr std::size_t kLongestString = 255;
constexpr int kManyCycles = 60;

class TheStructuredText : public ADispatcher {
 protected:
  TheStructuredText() {
    plc_.on_block("pause", [](const auto&) {});
    plc_.on_block("ask", [this](const auto& inputs) { ask(inputs); });
    plc_.set("pause.Q", std::int64_t{1});
    plc_.set("ask.busy", std::int64_t{0});
    plc_.set("ask.reply", std::string());
    plc_.set("recipe", std::string("chapter"));
    take_away();
    answer_result(false);
    MachineStatus machine;
    machine.signals = {.ready = true, .part_release = false};
    service_.machine = machine;
  }

  void put(const std::string& part) {
    plc_.set("part", part);
    plc_.set("partIsThere", std::int64_t{1});
  }
  void take_away() {
    plc_.set("part", std::string());
    plc_.set("partIsThere", std::int64_t{0});
  }
  void answer_result(bool is_taken) { plc_.set("resultTaken", std::int64_t{is_taken}); }
  [[nodiscard]] bool is_set(const std::string& output) const { return plc_.number(output) != 0; }

  /// Nothing may go that is not there, or that nobody let go.
  void cycle() {
    plc_.run();
    if (!is_set("partMayGo")) return;
    EXPECT_EQ(plc_.number("partIsThere"), 1);
    EXPECT_TRUE(free_.contains(plc_.text("part"))) << plc_.text("part") << " was let go";
  }
  bool run_until(const std::function<bool()>& condition) {
    for (int i = 0; i < kManyCycles && !condition(); ++i) cycle();
    EXPECT_TRUE(condition()) << plc_.number("step") << plc_.text("fault") << replies_.back();
    return condition();
  }
  void run_on() {
    for (int i = 0; i < kManyCycles; ++i) cycle();
  }
  void run_until_started(int starts) {
    run_until([&] { return service_.starts == starts; });
    run_until([&] { return plc_.number("step") == 2; });
  }
  /// The part's job: acquired, or not, and ended so.
  void acquire(std::int64_t seq) {
    free_.insert(service_.job(ClientSeq{seq}).request.part_id);
    service_.change({seq}, [](JobStatus& job) { job.acquired = true; });
  }
  void end(std::int64_t seq, std::optional<ErrorCode> error = std::nullopt) {
    service_.change({seq}, [&](JobStatus& job) {
      job.state = error ? JobState::kFailed : JobState::kCompleted;
      job.error = error;
      if (error == ErrorCode::kInterrupted) job.acquired = false;  // as the restart of the daemon leaves it
      job.ended_utc = "2026-11-30T10:00:00.000Z";
    });
  }
  /// The line takes the result of a part and answers.
  void take_result(const std::string& part) {
    ASSERT_TRUE(run_until([&] { return is_set("resultIsNew"); }));
    EXPECT_NE(plc_.text("result").find("\"part_id\":\"" + part + "\""), std::string::npos) << plc_.text("result");
    answer_result(true);
    run_until([&] { return !is_set("resultIsNew"); });
    answer_result(false);
  }
  [[nodiscard]] JobStatus job(std::int64_t seq) const { return service_.job(ClientSeq{seq}); }
  /// A known job, as of before.
  void let_know(std::int64_t seq, const std::string& part) {
    JobRequest request;
    request.seq = seq;
    request.part_id = part;
    static_cast<void>(service_.start(request));
  }

  test::StructuredText plc_{test::read_text(FVD_SOURCE_DIR "/daemon/api/examples/line_loop.st")};
  std::set<std::string> free_;  // parts that may go
  std::vector<std::string> requests_;
  std::vector<std::string> replies_{""};
  int replies_to_lose_ = 0;

 private:
  void ask(const std::map<std::string, test::StValue>& inputs) {
    plc_.set("ask.done", std::int64_t{0});
    if (std::get<std::int64_t>(inputs.at("start")) == 0) return;
    requests_.push_back(std::get<std::string>(inputs.at("request")));
    const std::string& line = requests_.back();
    ASSERT_EQ(line.find('\n'), line.size() - 1) << "a line has an end: " << line;
    const Handled handled = dispatcher_.handle(line.substr(0, line.size() - 1), caller_);
    if (replies_to_lose_ > 0) {
      --replies_to_lose_;
      return;
    }
    replies_.push_back(handled.reply.value_or(""));
    plc_.set("ask.reply", replies_.back());
    plc_.set("ask.done", std::int64_t{1});
  }
};

TEST_F(TheStructuredText, MeasuresOnePartAfterTheOther) {
  put("A");
  run_until_started(1);
  EXPECT_FALSE(is_set("partMayGo"));
  acquire(1);
  run_until([&] { return is_set("partMayGo"); });
  take_away();
  cycle();
  EXPECT_FALSE(is_set("partMayGo"));
  put("B");  // while A is computed
  run_on();
  EXPECT_FALSE(is_set("partMayGo"));
  EXPECT_EQ(service_.starts, 1);
  end(1);
  take_result("A");
  run_until_started(2);
  EXPECT_EQ(job(2).request.part_id, "B");
  EXPECT_TRUE(job(1).acknowledged);
}

TEST_F(TheStructuredText, NamesTheRecipeAndMeasuresNothingWithoutOne) {
  plc_.set("recipe", std::string());
  put("A");
  run_on();
  EXPECT_EQ(service_.starts, 0) << "it would be measured by whatever another client used last";
  plc_.set("recipe", std::string("chapter"));
  run_until([&] { return plc_.number("step") == 1; });
  plc_.set("recipe", std::string("groove"));  // for the next one
  run_until_started(1);
  EXPECT_EQ(job(1).request.recipe, "chapter");
}

TEST_F(TheStructuredText, MeasuresNothingTwiceThatStaysWhereItIs) {
  put("A");
  run_until_started(1);
  acquire(1);
  end(1);
  take_result("A");
  run_on();
  EXPECT_TRUE(is_set("partMayGo"));
  EXPECT_EQ(service_.starts, 1);
}

TEST_F(TheStructuredText, KeepsAResultUntilTheLineHasTakenIt) {
  put("A");
  run_until_started(1);
  acquire(1);
  end(1);
  run_until([&] { return is_set("resultIsNew"); });
  run_on();
  EXPECT_TRUE(is_set("resultIsNew"));
  EXPECT_FALSE(job(1).acknowledged);
  take_result("A");
  EXPECT_TRUE(job(1).acknowledged);
  take_away();
  cycle();
  answer_result(true);  // too long
  put("B");
  run_on();
  EXPECT_EQ(service_.starts, 1);
  answer_result(false);
  run_until_started(2);
  EXPECT_FALSE(is_set("resultIsNew"));
}

TEST_F(TheStructuredText, BeginsAColdStartBehindTheLastNumberWithASessionOfItsOwn) {
  let_know(7, "type 4");
  end(7);
  put("type 4");
  run_until_started(2);
  const std::string session = job(8).request.session;
  EXPECT_FALSE(session.empty());
  plc_.start_cold();
  run_until_started(3);
  EXPECT_NE(job(9).request.session, session);
}

TEST_F(TheStructuredText, GoesOnWhereThePowerWasLost) {
  constexpr int kPatience = 3;  // cycles that the line needs to answer
  for (int lost_after = 0; lost_after < 24; ++lost_after) {
    const auto seq = std::int64_t{lost_after} + 1;
    const std::string part = "part-" + std::to_string(lost_after);
    std::vector<std::string> results;
    int may_go_for = 0;
    int new_for = 0;
    put(part);
    for (int i = 0; i < kManyCycles; ++i) {
      if (i == lost_after) plc_.start_warm();
      cycle();
      if (i == 10 + lost_after % 3) acquire(seq);
      if (i == 14) end(seq);
      may_go_for = is_set("partMayGo") ? may_go_for + 1 : 0;
      if (may_go_for == kPatience) take_away();
      new_for = is_set("resultIsNew") ? new_for + 1 : 0;
      if (new_for == kPatience) results.push_back(plc_.text("result"));
      answer_result(new_for >= kPatience);
    }
    ASSERT_EQ(results.size(), 1U) << lost_after;
    EXPECT_NE(results[0].find(part), std::string::npos);
    EXPECT_EQ(plc_.number("partIsThere"), 0) << "it was let go";
    EXPECT_TRUE(job(seq).acknowledged);
    EXPECT_THROW(static_cast<void>(job(seq + 1)), Error) << "measured twice";
  }
}

TEST_F(TheStructuredText, TellsPeopleThatSomebodyElseHasControl) {
  const Caller page{.connection = 2, .who = {"token page", Role::kSetUp}};
  const auto ask = [&](const std::string& method, const nlohmann::json& params) {
    const std::string line =
        nlohmann::json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump();
    ASSERT_NE(dispatcher_.handle(line, page).reply.value().find("result"), std::string::npos);
  };
  ask("control.acquire", {{"owner", "anna"}});
  put("A");
  run_until([&] { return plc_.text("fault").find("anna") != std::string::npos; });
  EXPECT_EQ(service_.starts, 0);
  ask("control.release", nlohmann::json::object());
  run_until_started(1);
  EXPECT_TRUE(plc_.text("fault").empty());
}

TEST_F(TheStructuredText, TellsPeopleOfAPartThatWasLetGoAndHasNoResult) {
  put("A");
  run_until_started(1);
  acquire(1);
  run_until([&] { return is_set("partMayGo"); });
  take_away();
  cycle();
  put("B");
  end(1, ErrorCode::kInterrupted);
  run_until([&] { return is_set("resultIsNew"); });
  run_on();
  EXPECT_EQ(plc_.text("fault"), "has left without a result: A");
  EXPECT_EQ(service_.starts, 1) << "what lies there is another part";
  take_result("A");
  EXPECT_TRUE(plc_.text("fault").empty());
  run_until_started(2);
  EXPECT_EQ(job(2).request.part_id, "B");
}

TEST_F(TheStructuredText, MeasuresAPartOnceMoreThatIsStillThere) {
  put("A");
  run_until_started(1);
  end(1, ErrorCode::kInterrupted);
  run_until_started(2);
  EXPECT_EQ(job(2).request.part_id, "A");
  EXPECT_TRUE(job(1).acknowledged);
  EXPECT_FALSE(is_set("resultIsNew"));
  EXPECT_TRUE(plc_.text("fault").empty());
}

TEST_F(TheStructuredText, WaitsForTheReleaseOfAPartWhoseJobEndedWithoutIt) {
  put("A");
  run_until_started(1);
  end(1, ErrorCode::kStageDisconnected);
  take_result("A");
  run_on();
  EXPECT_FALSE(is_set("partMayGo"));
  EXPECT_EQ(service_.starts, 1);
  free_.insert("A");
  service_.machine->signals.part_release = true;
  run_until([&] { return is_set("partMayGo"); });
  take_away();
  cycle();
  service_.machine->signals.part_release = false;
  put("B");
  run_until_started(2);
}

TEST_F(TheStructuredText, LetsNoOtherPartGoWherePeopleTookTheOneOfAFailedJob) {
  put("A");
  run_until_started(1);
  end(1, ErrorCode::kStageDisconnected);
  take_result("A");
  take_away();
  cycle();
  put("B");
  service_.machine->signals.part_release = true;
  run_until_started(2);
  EXPECT_EQ(job(2).request.part_id, "B");
}

TEST_F(TheStructuredText, LooksForTheResultOfANumberThatIsRefusedAsOld) {
  put("A");
  run_until([&] { return plc_.number("step") == 1; });
  replies_to_lose_ = 1;
  run_until([&] { return service_.starts == 1; });
  acquire(1);
  end(1);
  service_.refusal = ErrorCode::kSeqStale;
  take_result("A");
  EXPECT_TRUE(is_set("partMayGo"));
  service_.refusal.reset();
  run_on();
  EXPECT_EQ(service_.starts, 1);
  EXPECT_TRUE(job(1).acknowledged);
}

TEST_F(TheStructuredText, AcknowledgesAnInterruptedJobWhoseReplyWasLost) {
  put("A");
  run_until([&] { return plc_.number("step") == 1; });
  replies_to_lose_ = 1;
  run_until([&] { return service_.starts == 1; });
  end(1, ErrorCode::kInterrupted);
  service_.refusal = ErrorCode::kInterrupted;
  run_until([&] { return plc_.number("step") == 0; });
  service_.refusal.reset();
  run_until_started(2);
  EXPECT_TRUE(job(1).acknowledged);
  EXPECT_EQ(job(2).request.part_id, "A");
}

TEST_F(TheStructuredText, TakesAnotherNumberInPlaceOfOneThatIsAnothersOrNobodys) {
  for (const ErrorCode code : {ErrorCode::kSeqConflict, ErrorCode::kSeqStale}) {
    plc_.start_cold();
    put("A");
    run_until([&] { return plc_.number("step") == 1; });
    const int starts = service_.starts;
    const std::int64_t refused = plc_.number("seq");
    service_.refusal = code;
    run_until([&] { return plc_.number("step") == 5; });
    service_.refusal.reset();
    let_know(refused + 4, "of another");
    run_until_started(starts + 2);
    EXPECT_EQ(job(refused + 5).request.part_id, "A");
    take_away();
    cycle();
  }
}

TEST_F(TheStructuredText, NeverUsesAnotherPartsResult) {
  put("A");
  run_until_started(1);
  acquire(1);
  end(1);
  service_.change({1}, [](JobStatus& job) { job.request.part_id = "X"; });
  run_until([&] { return !plc_.text("fault").empty(); });
  run_on();
  EXPECT_FALSE(is_set("resultIsNew"));
  EXPECT_FALSE(job(1).acknowledged);
  service_.change({1}, [](JobStatus& job) { job.request.part_id = "A"; });
  take_result("A");
  EXPECT_TRUE(plc_.text("fault").empty());
}

TEST_F(TheStructuredText, ShowsAFaultAsLongAsItLasts) {
  put("A");
  service_.refusal = ErrorCode::kUnknownRecipe;
  run_until([&] { return !plc_.text("fault").empty(); });
  service_.refusal.reset();
  run_until_started(1);
  EXPECT_TRUE(plc_.text("fault").empty());
}

TEST_F(TheStructuredText, WaitsSilentlyWhileTheMachineIsNotReady) {
  service_.machine->signals.ready = false;
  put("A");
  run_on();
  EXPECT_EQ(service_.starts, 0);
  service_.machine->signals.ready = true;
  service_.refusal = ErrorCode::kBusy;
  run_on();
  EXPECT_TRUE(plc_.text("fault").empty());
  service_.refusal.reset();
  run_until_started(1);
}

TEST_F(TheStructuredText, KeepsToTheLengthOfAControllersString) {
  constexpr std::int64_t kLongestSeq = 9007199254740990;
  let_know(kLongestSeq - 1, "x");
  const std::string part(64, 'p');
  plc_.set("recipe", std::string(40, 'r'));
  put(part);
  run_until_started(2);
  acquire(kLongestSeq);
  end(kLongestSeq);
  take_result(part);
  std::set<std::string> methods;
  for (const std::string& request : requests_) {
    EXPECT_LE(request.size(), kLongestString) << request;
    methods.insert(json::parse(request)["method"]);
  }
  EXPECT_EQ(methods.size(), 6U);
}

}  // namespace
}  // namespace fvd
