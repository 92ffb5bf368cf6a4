#include "daemon/jobs/audit_log.hpp"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
#include "tests/daemon/store/held_disk.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/scratch_dir.hpp"

namespace fvd {
namespace {

AuditEntry entry(const std::string& what) {
  AuditEntry made;
  made.who = "uid 0";
  made.what = what;
  made.outcome = "ok";
  return made;
}

TEST(AuditLog, KeepsWhatWasNotedInItsOrderOverARestart) {
  const test::ScratchDir folder;
  {
    JobStore store(folder / "fvd.sqlite");
    AuditLog log(store.audit());
    for (int i = 0; i < 50; ++i) log.note(entry("start " + std::to_string(i)));
    const auto deadline = HostClock::now() + std::chrono::seconds(60);
    auto newest = log.newest(10, 0);
    while ((newest.empty() || newest.front().what != "start 49") && HostClock::now() < deadline) {
      newest = log.newest(10, 0);  // a slow disk is waited for a moment only
    }
    ASSERT_EQ(newest.size(), 10U);
    EXPECT_EQ(newest.front().what, "start 49");
    EXPECT_EQ(newest.front().time_utc.size(), std::string("2026-11-30T10:00:00.000Z").size());
    log.note(entry("the last"));
  }
  JobStore store(folder / "fvd.sqlite");
  EXPECT_EQ(store.audit().newest(1).front().what, "the last");
  const auto before = store.audit().newest(1000, 3);
  ASSERT_EQ(before.size(), 2U);
  EXPECT_EQ(before.back().what, "start 0");
  EXPECT_EQ(before.back().number, 1);
}

TEST(AuditLog, IsNotFilledByRefusals) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  {
    AuditLog log(store.audit());
    log.note(entry("job.start"));
    AuditEntry refused = entry("stage.move");
    refused.outcome = "not_allowed";
    for (int i = 0; i < 500; ++i) log.note(refused);
    refused.who = "somebody else";
    log.note(refused);
    for (int i = 0; i < 100; ++i) log.note(entry("stage.stop"));
  }
  const auto rows = store.audit().newest(1000);
  const auto count = [&rows](const std::string& what, const std::string& who) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const AuditEntry& row) { return row.what == what && row.who == who; });
  };
  EXPECT_EQ(count("job.start", "uid 0"), 1);
  EXPECT_EQ(count("stage.stop", "uid 0"), 100) << "what was done has its row always";
  EXPECT_EQ(count("stage.move", "somebody else"), 1);
  EXPECT_EQ(count("stage.move", "uid 0"), AuditLog::kMostRefusals + 1);
  EXPECT_EQ(rows.front().detail,
            std::to_string(500 - AuditLog::kMostRefusals) + " refusals within a minute; this is the last");
}

TEST(AuditLog, AnswersAReaderWhileTheDiskTakesItsTime) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  store.audit().add({entry("first")});
  test::HeldDisk disk;
  AuditLog log(store.audit());  // ends before the disk is as it was
  log.note(entry("second"));
  disk.await_a_write();
  const auto rows = log.newest(10, 0);
  EXPECT_THAT(rows, testing::ElementsAre(testing::Field(&AuditEntry::what, "first")))
      << "what is not written yet is not waited for";
  disk.let_go();
}

TEST(AuditLog, TellsNothingOfALossWhereTheDiskTookAll) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  const test::CapturedLog told;
  {
    test::HeldDisk disk;
    AuditLog log(store.audit());
    log.note(entry("first"));
    disk.await_a_write();
    for (std::size_t i = 0; i < AuditLog::kMostKept; ++i) log.note(entry("later"));
    disk.let_go();
  }
  EXPECT_EQ(store.audit().newest(2000).size(), AuditLog::kMostKept + 1);
  EXPECT_EQ(told.text(), "");
}

TEST(AuditLog, HasTheEndOfWhatWasAcceptedHoweverOftenItsCallerWasRefused) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  {
    AuditLog log(store.audit());
    AuditEntry refused = entry("job.start");
    refused.outcome = "busy";
    for (int i = 0; i < 2 * AuditLog::kMostRefusals; ++i) log.note(refused);
    AuditEntry move = entry("stage.move");
    move.outcome = "accepted";
    log.note(move);
    move.outcome = "stage_alarm";
    move.is_end = true;
    for (int i = 0; i < 2 * AuditLog::kMostRefusals; ++i) log.note(move);
  }
  const auto rows = store.audit().newest(1000);
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const AuditEntry& row) { return row.outcome == "stage_alarm"; }),
            2 * AuditLog::kMostRefusals);
  EXPECT_EQ(rows.front().detail,
            std::to_string(AuditLog::kMostRefusals) + " refusals within a minute; this is the last");
}

TEST(AuditLog, IsNotFilledByRefusalsOfManyEither) {
  const test::ScratchDir folder;
  JobStore store(folder / "fvd.sqlite");
  constexpr int kRounds = 3;
  constexpr int kOthers = 300;
  {
    AuditLog log(store.audit());
    AuditEntry refused = entry("stage.move");
    refused.outcome = "not_allowed";
    for (int round = 0; round < kRounds; ++round) {
      refused.who = "one of them";
      for (int i = 0; i < 40; ++i) log.note(refused);
      for (int other = 0; other < kOthers; ++other) {
        refused.who = "somebody " + std::to_string(round * kOthers + other);
        log.note(refused);
      }
    }
  }
  const auto rows = store.audit().newest(10000);
  EXPECT_EQ(std::count_if(rows.begin(), rows.end(), [](const AuditEntry& row) { return row.who == "one of them"; }),
            AuditLog::kMostRefusals + 1);
  const int apart = static_cast<int>(AuditLog::kMostRefused) - 1;
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(apart + 2 * AuditLog::kMostRefusals + 2));
  const std::string counted = std::to_string(kRounds * kOthers - apart - AuditLog::kMostRefusals);
  EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&counted](const AuditEntry& row) {
    return row.detail == counted + " refusals of others within a minute; this is the last";
  }));
}

}  // namespace
}  // namespace fvd
