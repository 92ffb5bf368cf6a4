#include "daemon/jobs/audit_log.hpp"

#include <algorithm>
#include <thread>

#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
#include "tests/daemon/store/held_disk.hpp"
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
    const auto newest = log.newest(10, 0);
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
  AuditLog log(store.audit());
  log.note(entry("first"));
  while (log.newest(10, 0).empty()) std::this_thread::yield();
  test::HeldDisk disk;
  log.note(entry("second"));
  disk.await_a_write();
  const auto rows = log.newest(10, 0);
  ASSERT_EQ(rows.size(), 1U) << "what is not written yet is not waited for";
  EXPECT_EQ(rows.front().what, "first");
  disk.let_go();
}

}  // namespace
}  // namespace fvd
