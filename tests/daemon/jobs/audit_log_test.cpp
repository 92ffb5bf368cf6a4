#include "daemon/jobs/audit_log.hpp"

#include <gtest/gtest.h>

#include "daemon/store/job_store.hpp"
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

}  // namespace
}  // namespace fvd
