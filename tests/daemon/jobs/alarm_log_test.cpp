/// The newest warnings and errors: which are kept, how repeated ones count, and what their texts may be.

#include "daemon/jobs/alarm_log.hpp"

#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spdlog/logger.h>
#include <spdlog/spdlog.h>

#include "daemon/access/refused_calls.hpp"
#include "daemon/jobs/alarm_sink.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class AnAlarmLog : public ::testing::Test {
 protected:
  void note(const std::string& text, AlarmLevel level = AlarmLevel::kWarning) { log_.note(level, text, now_); }
  [[nodiscard]] Alarm newest() const { return log_.newest().front(); }
  /// Of a line that is none that came before.
  [[nodiscard]] std::string text_of(const std::string& text) {
    now_ += AlarmLog::kRepeatTime;
    note(text);
    return newest().text;
  }

  AlarmLog log_;
  std::chrono::system_clock::time_point now_{seconds(1'800'000'000) + milliseconds(7)};
};

TEST_F(AnAlarmLog, HasNothingAtFirst) {
  EXPECT_TRUE(log_.newest().empty());
  EXPECT_EQ(log_.revision(), 0U);
  FVD_EXPECT_ERROR_SAYING(kBadInput, log_.acknowledge(1, ""), HasSubstr("no alarm 1"));
}

TEST_F(AnAlarmLog, TellsTheNewestFirstWithNumberTimeAndLevel) {
  note("a");
  now_ += milliseconds(1500);
  note("b", AlarmLevel::kCritical);

  const auto alarms = log_.newest();
  ASSERT_THAT(alarms, SizeIs(2));
  EXPECT_EQ(alarms[0].number, 2);
  EXPECT_EQ(alarms[0].text, "b");
  EXPECT_EQ(alarm_level_name(alarms[0].level), "critical");
  EXPECT_EQ(alarms[0].time_utc, "2027-01-15T08:00:01.507Z");
  EXPECT_EQ(alarms[1].time_utc, "2027-01-15T08:00:00.007Z");
  EXPECT_EQ(alarms[1].count, 1);
  EXPECT_FALSE(alarms[1].acknowledged);
}

TEST_F(AnAlarmLog, KeepsTheNewestTwoHundred) {
  for (int i = 1; i <= 250; ++i) note("line " + std::to_string(i));
  const auto alarms = log_.newest();
  ASSERT_THAT(alarms, SizeIs(200));
  EXPECT_EQ(alarms.front().number, 250);
  EXPECT_EQ(alarms.back().number, 51);
  EXPECT_EQ(alarms.back().text, "line 51");
  FVD_EXPECT_ERROR_SAYING(kBadInput, log_.acknowledge(50, ""), HasSubstr("alarm.list"));
  FVD_EXPECT_ERROR(kBadInput, log_.acknowledge(251, ""));
  FVD_EXPECT_ERROR(kBadInput, log_.acknowledge(0, ""));
  FVD_EXPECT_ERROR(kBadInput, log_.acknowledge(std::numeric_limits<std::int64_t>::min(), ""));
  log_.acknowledge(51, "");
  EXPECT_TRUE(log_.newest().back().acknowledged);
}

TEST_F(AnAlarmLog, DropsWhatWasSeenFirstThenWarningsThenErrors) {
  note("no job is taken", AlarmLevel::kCritical);
  note("job 1 failed", AlarmLevel::kError);
  note("job 2 failed", AlarmLevel::kError);
  for (int i = 4; i <= 200; ++i) note("line " + std::to_string(i));
  log_.acknowledge(2, "");
  log_.acknowledge(100, "");
  const auto numbers = [this] {
    std::vector<std::int64_t> told;
    for (const Alarm& alarm : log_.newest()) told.push_back(alarm.number);
    return told;
  };

  note("line 201");
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Not(Contains(2)), Contains(100))) << "the oldest that was seen";
  note("line 202");
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Not(Contains(100)), Contains(4)));
  note("line 203");
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Not(Contains(4)), Contains(1), Contains(3))) << "the oldest warning";
  for (int i = 1; i <= 198; ++i) note("error " + std::to_string(i), AlarmLevel::kError);
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Contains(1), Contains(3), Contains(401))) << "no warning is left";
  note("line 402");
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Contains(3), Not(Contains(402)))) << "no error goes for a warning";
  note("error 403", AlarmLevel::kError);
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Contains(1), Not(Contains(3)), Contains(403)));
  for (int i = 1; i <= 250; ++i) note("critical " + std::to_string(i), AlarmLevel::kCritical);
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Not(Contains(1)), Contains(653), Contains(454), Not(Contains(453))));
  note("error 654", AlarmLevel::kError);
  EXPECT_THAT(numbers(), AllOf(SizeIs(200), Contains(454), Not(Contains(654))));
}

TEST_F(AnAlarmLog, AcknowledgesNoAlarmOfAnotherStart) {
  note("a");
  FVD_EXPECT_ERROR_SAYING(
      kBadInput, log_.acknowledge(1, "2027-01-15T07:00:00.007Z"),
      AllOf(HasSubstr("2027-01-15T08:00:00.007Z"), HasSubstr("started again"), HasSubstr("alarm.list")));
  FVD_EXPECT_ERROR(kBadInput, log_.acknowledge(1, "x"));
  EXPECT_FALSE(newest().acknowledged);
  EXPECT_EQ(log_.revision(), 1U);
  now_ += seconds(1);
  note("a");
  log_.acknowledge(1, "2027-01-15T08:00:00.007Z");
  EXPECT_TRUE(newest().acknowledged) << "by the time at which it was told first";
}

TEST_F(AnAlarmLog, CountsALineThatComesAgainInPlaceOfPushingOthersOut) {
  note("the first");
  for (int i = 0; i < 1000; ++i) {
    note("the disk is slow");
    note("the stage is slow");
    now_ += seconds(1);
  }
  const auto alarms = log_.newest();
  ASSERT_THAT(alarms, SizeIs(3));
  EXPECT_EQ(alarms[1].text, "the disk is slow");
  EXPECT_EQ(alarms[1].count, 1000);
  EXPECT_EQ(alarms[1].time_utc, "2027-01-15T08:00:00.007Z");
  EXPECT_EQ(alarms[1].last_utc, "2027-01-15T08:16:39.007Z");
  EXPECT_EQ(alarms[2].text, "the first");
}

TEST_F(AnAlarmLog, TakesALineForAnotherOneAfterAMinuteAtAnotherLevelAndOnceItWasSeen) {
  note("x");
  now_ += seconds(59);
  note("x");
  EXPECT_EQ(newest().count, 2);
  now_ += seconds(60);
  note("x");
  EXPECT_EQ(newest().number, 2) << "a minute after the last one";
  note("x", AlarmLevel::kError);
  EXPECT_EQ(newest().number, 3);
  log_.acknowledge(3, "");
  note("x", AlarmLevel::kError);
  EXPECT_EQ(newest().number, 4) << "who has seen the one has not seen the other";
  note("x", AlarmLevel::kError);
  EXPECT_EQ(newest().count, 2);
  EXPECT_EQ(log_.newest()[1].count, 1);
  note("x ", AlarmLevel::kError);
  EXPECT_EQ(newest().number, 5);
  now_ -= seconds(3600);  // a clock that is set
  note("x ", AlarmLevel::kError);
  EXPECT_EQ(newest().count, 2);
}

TEST_F(AnAlarmLog, AcknowledgesTheOneThatIsNamed) {
  for (const char* text : {"a", "b", "c"}) note(text);
  log_.acknowledge(2, "");
  log_.acknowledge(2, "");
  std::vector<bool> seen;
  for (const Alarm& alarm : log_.newest()) seen.push_back(alarm.acknowledged);
  EXPECT_EQ(seen, (std::vector<bool>{false, true, false}));
}

TEST_F(AnAlarmLog, CountsItsChanges) {
  note("a");
  EXPECT_EQ(log_.revision(), 1U);
  note("a");
  EXPECT_EQ(log_.revision(), 2U) << "the count is another";
  log_.acknowledge(1, "");
  EXPECT_EQ(log_.revision(), 3U);
  log_.acknowledge(1, "");
  EXPECT_EQ(log_.revision(), 3U) << "nothing changed";
  FVD_EXPECT_ERROR(kBadInput, log_.acknowledge(2, ""));
  EXPECT_EQ(log_.revision(), 3U);
}

TEST_F(AnAlarmLog, CutsATextBehindWholeCharacters) {
  EXPECT_EQ(text_of(std::string(500, 'x')), std::string(500, 'x'));
  EXPECT_EQ(text_of(std::string(501, 'x')), std::string(497, 'x') + "...");
  EXPECT_EQ(text_of(std::string(1'000'000, 'y')), std::string(497, 'y') + "...");
  for (const std::string character : {"\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x94\xac"}) {
    for (std::size_t before = 0; before < 4; ++before) {
      std::string text(before, 'x');
      while (text.size() < 700) text += character;
      const std::string told = text_of(text);
      EXPECT_LE(told.size(), 500U);
      EXPECT_GE(told.size(), 497U);
      EXPECT_THAT(told, EndsWith(character + "..."));
    }
  }
}

TEST_F(AnAlarmLog, TellsWhatIsNoCharacterAsAQuestionMark) {
  EXPECT_EQ(text_of("part '\xff\xfe'"), "part '??'");
  EXPECT_EQ(text_of("\xc3"), "?") << "half of one at the end";
  EXPECT_EQ(text_of("\xc3x"), "?x");
  EXPECT_EQ(text_of("\xe2\x82x"), "??x");
  EXPECT_EQ(text_of("\xc0\xaf"), "??") << "another spelling of /";
  EXPECT_EQ(text_of("\xe0\x80\xaf"), "???");
  EXPECT_EQ(text_of("\xf0\x80\x80\xaf"), "????");
  EXPECT_EQ(text_of("\xed\xa0\x80"), "???") << "half of a pair";
  EXPECT_EQ(text_of("\xf4\x90\x80\x80"), "????") << "beyond the last character";
  EXPECT_EQ(text_of("\xf5\x80\x80\x80"), "????");
  EXPECT_EQ(text_of(std::string("a\0b\n", 4)), std::string("a\0b\n", 4)) << "JSON has a word for these";
  EXPECT_EQ(text_of(""), "");
  // Every lead byte with every second one: what is told is what JSON takes.
  for (int first = 0x80; first < 0x100; ++first) {
    for (int second = 0; second < 0x100; ++second) {
      const std::string bytes{static_cast<char>(first), static_cast<char>(second), '\x80', '\x80'};
      EXPECT_NO_THROW((void)nlohmann::json(text_of(bytes)).dump()) << first << " " << second;
    }
  }
}

TEST_F(AnAlarmLog, TakesLinesFromSeveralThreads) {
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([this, thread] {
        for (int i = 0; i < 500; ++i) {
          log_.note(AlarmLevel::kError, "thread " + std::to_string(thread), now_);
          (void)log_.newest();
          if (i % 50 == 0) log_.acknowledge(log_.newest().front().number, "");
        }
      });
    }
  }
  std::int64_t lines = 0;
  for (const Alarm& alarm : log_.newest()) lines += alarm.count;
  EXPECT_EQ(lines, 2000);
  EXPECT_GE(log_.revision(), 2000U);
}

TEST(AnAlarmSink, NotesLinesOfLevelWarningAndAbove) {
  const auto alarms = std::make_shared<AlarmLog>();
  spdlog::logger logger("test", alarm_sink(alarms));
  logger.set_level(spdlog::level::trace);
  logger.set_pattern("%v and a lot more");
  logger.debug("no");
  logger.info("no");
  logger.warn("a {}", 1);
  logger.error("b");
  logger.critical("c");

  const auto told = alarms->newest();
  ASSERT_THAT(told, SizeIs(3));
  EXPECT_EQ(told[2].text, "a 1");
  EXPECT_EQ(told[2].level, AlarmLevel::kWarning);
  EXPECT_EQ(told[1].level, AlarmLevel::kError);
  EXPECT_EQ(told[0].level, AlarmLevel::kCritical);
  EXPECT_GT(told[0].time_utc, "2020") << "the line's time";
}

TEST(AnAlarmSink, LeavesRefusedCallsOut) {
  const auto alarms = std::make_shared<AlarmLog>();
  const test::CapturedLog log;
  spdlog::default_logger()->sinks().push_back(alarm_sink(alarms));
  RefusedCalls refused;
  for (int port = 1; port <= 16; ++port) {
    const std::string number = std::to_string(port);
    refused.tell("address 10.0.0." + number, "HTTP from 10.0.0.9:" + number + " was refused");
  }
  spdlog::warn("the disk is nearly full");
  ASSERT_THAT(alarms->newest(), SizeIs(1));
  EXPECT_EQ(alarms->newest()[0].text, "the disk is nearly full");
  EXPECT_EQ(log.lines_with("was refused"), 16U) << "the log has them";
  EXPECT_EQ(log.lines_with("[warning]"), 17U);
}

}  // namespace
}  // namespace fvd
