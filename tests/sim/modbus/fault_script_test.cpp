#include "sim/modbus/fault_script.hpp"

#include "gtest/gtest.h"
#include "sim/faults/fault_config.hpp"
#include "sim/modbus/scripted_responder.hpp"
#include "tests/sim/modbus/modbus_requests.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd::sim {
namespace {

using std::chrono::milliseconds;
using test::short_request;
using test::write_request;

const ModbusBytes kRead = short_request(3, 10, 2);
const ModbusBytes kWrite = write_request(20, {1, 2});

bool happens(FaultScript& script, const ModbusBytes& request, bool moves = false) {
  return script.next(request, moves).has_value();
}

TEST(FaultScript, TakesItsStepsInOrder) {
  FaultScript script({{.on = FaultOn::kWrite, .fault = FaultKind::kLostReply},
                      {.on = FaultOn::kRead, .after = 1, .count = 2, .fault = FaultKind::kLostRequest},
                      {.fault = FaultKind::kLinkCut}});
  EXPECT_FALSE(happens(script, kRead)) << "the first step waits for a write";
  EXPECT_EQ(script.next(kWrite, false)->fault, FaultKind::kLostReply);
  EXPECT_FALSE(happens(script, kRead)) << "one passes";
  EXPECT_FALSE(happens(script, kWrite));
  EXPECT_EQ(script.next(kRead, false)->fault, FaultKind::kLostRequest);
  EXPECT_EQ(script.next(kRead, false)->fault, FaultKind::kLostRequest);
  EXPECT_EQ(script.unconsumed(), 1U);
  EXPECT_EQ(script.next(kWrite, false)->fault, FaultKind::kLinkCut);
  EXPECT_EQ(script.unconsumed(), 0U);
  EXPECT_EQ(script.describe_unconsumed(), "");
  EXPECT_FALSE(happens(script, kRead));
}

TEST(FaultScript, WaitsForItsAddress) {
  FaultScript script({{.address = 21, .fault = FaultKind::kLostReply}});
  EXPECT_FALSE(happens(script, kRead));
  EXPECT_FALSE(happens(script, write_request(22, {1})));
  EXPECT_TRUE(happens(script, kWrite));
}

TEST(FaultScript, WaitsForMotionWithAnAlarmInMotion) {
  FaultScript script({{.fault = FaultKind::kAlarmInMotion, .code = 0x30}});
  EXPECT_FALSE(happens(script, kRead, false));
  EXPECT_TRUE(happens(script, kRead, true));
}

TEST(FaultScript, TellsWhatHasNotHappened) {
  FaultScript script({{.fault = FaultKind::kLostReply},
                      {.on = FaultOn::kWrite, .after = 3, .address = 20, .count = 2, .fault = FaultKind::kWrongCrc},
                      {.on = FaultOn::kRead, .fault = FaultKind::kPowerCycle}});
  EXPECT_TRUE(happens(script, kRead));
  EXPECT_FALSE(happens(script, kWrite));
  EXPECT_EQ(script.unconsumed(), 2U);
  EXPECT_EQ(script.describe_unconsumed(),
            "step 2: wrong_crc on write of address 20, after 2 more, 2 times to go\n"
            "step 3: power_cycle on read, 1 time to go");
}

TEST(FaultScript, RefusesStepsThatCannotHappen) {
  const std::vector<FaultStep> wrong{{.after = -1},
                                     {.count = 0},
                                     {.fault = FaultKind::kLateReply},
                                     {.fault = FaultKind::kStaleInPosition},
                                     {.fault = FaultKind::kException},
                                     {.fault = FaultKind::kException, .code = 256},
                                     {.fault = FaultKind::kAlarmInMotion},
                                     {.fault = FaultKind::kExceptionAfter},
                                     {.fault = FaultKind::kSecondMaster},
                                     {.fault = FaultKind::kSecondMaster, .to = 65535, .words = {1, 2}},
                                     {.fault = FaultKind::kSecondMaster, .words = std::vector<std::uint16_t>(124)},
                                     {.fault = FaultKind::kLateReply, .delay = milliseconds(-1)}};
  for (const FaultStep& step : wrong) {
    fvd::test::expect_error(ErrorCode::kBadConfig, {"fault step"}, [&] { FaultScript({step}); });
  }
}

TEST(FaultConfig, ReadsEveryField) {
  const auto steps = read_fault_steps(R"([ // as people write it
      {"on": "write", "after": 2, "address": 102, "count": 3, "fault": "late_reply", "delay_ms": 300},
      {"fault": "exception", "code": 6}])",
                                      "script");
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].on, FaultOn::kWrite);
  EXPECT_EQ(steps[0].after, 2);
  EXPECT_EQ(steps[0].address, 102);
  EXPECT_EQ(steps[0].count, 3);
  EXPECT_EQ(steps[0].fault, FaultKind::kLateReply);
  EXPECT_EQ(steps[0].delay, milliseconds(300));
  EXPECT_EQ(steps[1].on, FaultOn::kAny);
  EXPECT_EQ(steps[1].address, std::nullopt);
  EXPECT_EQ(steps[1].code, 6);
  const auto second = read_fault_steps(R"([{"fault": "second_master", "to": 124, "words": [103, 0]}])", "script");
  EXPECT_EQ(second[0].to, 124);
  EXPECT_EQ(second[0].words, (std::vector<std::uint16_t>{103, 0}));
}

TEST(FaultConfig, KnowsEveryFaultByItsName) {
  ASSERT_EQ(fault_names().size(), static_cast<std::size_t>(FaultKind::kSecondMaster) + 1);
  for (const auto& name : fault_names()) {
    const auto steps =
        read_fault_steps(R"([{"delay_ms": 1, "code": 1, "words": [1], "fault": ")" + name + "\"}]", "script");
    EXPECT_EQ(name_of(steps[0].fault), name);
  }
}

TEST(FaultConfig, SaysEverythingThatIsWrongAndWhere) {
  fvd::test::expect_error(
      ErrorCode::kBadConfig,
      {"script", "/0/fault", "/1/on", "/1/after", "/2/fault", "/2/delayms", "did you mean", "/3", "needs delay_ms"},
      [] {
        (void)read_fault_steps(
            R"([{"fault": "late"}, {"on": "reed", "after": -1, "fault": "lost_reply"}, {"delayms": 3},
                                   {"fault": "late_reply"}])",
            "script");
      });
  fvd::test::expect_error(ErrorCode::kBadConfig, {"/0/words/1", "integer"}, [] {
    (void)read_fault_steps(R"([{"fault": "second_master", "words": [1, 0.5]}])", "script");
  });
  fvd::test::expect_error(ErrorCode::kBadConfig, {"not a list"}, [] { (void)read_fault_steps("{}", "script"); });
  fvd::test::expect_error(ErrorCode::kBadConfig, {"script"}, [] { (void)read_fault_steps("[", "script"); });
  fvd::test::expect_error(ErrorCode::kBadConfig, {"/0"}, [] { (void)read_fault_steps("[7]", "script"); });
  fvd::test::expect_error(ErrorCode::kBadInput, {"nowhere"}, [] { (void)load_fault_steps("/nowhere.json"); });
}

/// Remembers what befell it.
struct Victim final : DriveFaults {
  void raise_alarm(int code) override { story += "alarm " + std::to_string(code) + ";"; }
  void limit_hit() override { story += "limit;"; }
  void emergency_stop() override { story += "stop;"; }
  void power_cycle() override { story += "power;"; }
  void refuse_moves(int count) override { story += "refuse " + std::to_string(count) + ";"; }
  void hold_in_position(HostClock::duration duration) override {
    story += "hold " + std::to_string(std::chrono::duration_cast<milliseconds>(duration).count()) + ";";
  }
  void exchange_words(bool exchanged) override { story += exchanged ? "exchange;" : "restore;"; }
  [[nodiscard]] bool axis_moves() override { return moves; }

  std::string story;
  bool moves = false;
};

TEST(ScriptedResponder, LetsDriveFaultsBefallTheDrive) {
  FaultScript script({{.fault = FaultKind::kSilentRefusal},
                      {.fault = FaultKind::kStaleInPosition, .delay = milliseconds(20)},
                      {.fault = FaultKind::kAlarmInMotion, .code = 48},
                      {.fault = FaultKind::kLimitHit},
                      {.fault = FaultKind::kEmergencyStop},
                      {.fault = FaultKind::kPowerCycle, .delay = milliseconds(5)}});
  test::PlainBank bank;
  Victim victim;
  ScriptedResponder responder(bank, &script, &victim);
  EXPECT_FALSE(responder.answer(kWrite).pdu.empty());
  EXPECT_FALSE(responder.answer(kWrite).pdu.empty());
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_EQ(victim.story, "refuse 1;hold 20;") << "no alarm without motion";
  victim.moves = true;
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  const LineAnswer off = responder.answer(kRead);
  EXPECT_EQ(victim.story, "refuse 1;hold 20;alarm 48;limit;stop;power;");
  EXPECT_TRUE(off.pdu.empty());
  EXPECT_TRUE(off.cut);
  EXPECT_EQ(off.outage, milliseconds(5));
}

TEST(ScriptedResponder, AnswersExceptionsWithoutExecuting) {
  FaultScript script({{.fault = FaultKind::kException, .code = 6}});
  test::PlainBank bank;
  ScriptedResponder responder(bank, &script, nullptr);
  EXPECT_EQ(responder.answer(kWrite).pdu, (ModbusBytes{0x90, 6}));
  EXPECT_EQ(bank.writes(), 0);
}

TEST(ScriptedResponder, AnswersExceptionsAfterExecuting) {
  FaultScript script({{.fault = FaultKind::kExceptionAfter, .code = 5}});
  test::PlainBank bank;
  ScriptedResponder responder(bank, &script, nullptr);
  EXPECT_EQ(responder.answer(kWrite).pdu, (ModbusBytes{0x90, 5}));
  EXPECT_EQ(bank.at(21), 2) << "executed";
}

TEST(ScriptedResponder, ExchangesWordsForOneRequest) {
  FaultScript script({{.fault = FaultKind::kSwappedWords}});
  test::PlainBank bank;
  Victim victim;
  ScriptedResponder responder(bank, &script, &victim);
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_EQ(victim.story, "exchange;restore;");
}

TEST(ScriptedResponder, LetsASecondMasterWriteFirst) {
  FaultScript script({{.fault = FaultKind::kSecondMaster, .to = 10, .words = {7, 8}}});
  test::PlainBank bank;
  ScriptedResponder responder(bank, &script, nullptr);
  EXPECT_EQ(responder.answer(kRead).pdu, (ModbusBytes{3, 4, 0, 7, 0, 8}));
  EXPECT_EQ(script.unconsumed(), 0U);
}

TEST(ScriptedResponder, TellsOfASecondMasterWhomTheDriveRefused) {
  FaultScript script({{.fault = FaultKind::kSecondMaster, .to = 99, .words = {7, 8}}});
  test::PlainBank bank;
  ScriptedResponder responder(bank, &script, nullptr);
  EXPECT_FALSE(responder.answer(kRead).pdu.empty());
  EXPECT_EQ(script.unconsumed(), 1U);
  EXPECT_EQ(script.describe_unconsumed(), "second_master: the drive refused 2 words from register 99 on, exception 2");
}

TEST(ScriptedResponder, DoesWithoutScriptAndDrive) {
  test::PlainBank bank;
  ScriptedResponder responder(bank, nullptr, nullptr);
  EXPECT_EQ(responder.answer(kWrite).pdu, short_request(16, 20, 2));
}

}  // namespace
}  // namespace fvd::sim
