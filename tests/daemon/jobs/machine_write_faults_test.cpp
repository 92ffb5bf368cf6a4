/// A whole job on the engine, each call that writes failing: what clients are told, and that it goes on afterwards.

#include <array>
#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <map>
#include <system_error>

#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include "daemon/export/file_calls.hpp"
#include "daemon/jobs/device_commands.hpp"
#include "daemon/jobs/reconcile_results.hpp"
#include "gtest/gtest.h"
#include "tests/daemon/jobs/engine_bench.hpp"
#include "tests/daemon/jobs/faulty_calls.hpp"
#include "tests/daemon/store/broken_disk.hpp"

namespace fvd {
namespace {

namespace fs = std::filesystem;

/// Jobs in a row on one machine, a fault in each.
class AMachineOnABadDisk : public test::AnEngine {
 protected:
  AMachineOnABadDisk() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
  ~AMachineOnABadDisk() override { spdlog::set_level(level_); }

  static bool all() { return std::getenv("FVD_ALL_WRITE_FAULTS") != nullptr; }

  /// The number of the job, or nothing where it was refused with a reason of the disk.
  std::optional<std::int64_t> start_refusably() {
    const std::int64_t seq = ++seq_;
    const int moves = bench_.moves;
    try {
      (void)jobs().start({seq, "a", "part"});
      return seq;
    } catch (const Error& error) {
      if (!is_of_the_disk(error.code())) wrong("job " + std::to_string(seq) + " was refused: " + error.what());
      if (bench_.moves != moves) wrong("a job that was refused moved the stage");
      return std::nullopt;
    }
  }
  static bool is_of_the_disk(ErrorCode code) {
    return code == ErrorCode::kStorageFull || code == ErrorCode::kStorageWrite || code == ErrorCode::kDatabase;
  }

  /// Ended as it was told, whole or without a result.
  void look_at_the_end(std::int64_t seq) {
    if (!await_end_of(seq)) return wrong("job " + std::to_string(seq) + " does not end");
    const JobStatus told = *machine().snapshot()->job;
    told_[seq] = told.state;
    if (told.state != JobState::kCompleted && (!told.error || !is_of_the_disk(*told.error)))
      wrong("job " + std::to_string(seq) + " ended otherwise: " + told.error_message);
  }
  /// After the disk was mended.
  void look_at_the_machine() {
    const int moves = bench_.moves;
    if (!await([](const MachineStatus& now) { return now.signals.ready; }))
      return wrong("it is not ready again: " + machine().snapshot()->error_message);
    for (const auto& [seq, state] : told_) {
      const StoredJob job = store_->find(ClientSeq{seq});
      if (job.status.state != state) wrong("job " + std::to_string(seq) + " is told otherwise than before");
      if (state == JobState::kCompleted && !fs::exists(fs::path(job.result_dir) / "result.json"))
        wrong("job " + std::to_string(seq) + " has no result");
    }
    told_.clear();
    if (bench_.moves != moves) wrong("the stage moved again");
  }
  /// Every folder that can be seen is the result of a job that has one, at the latest after the next start: a disk that
  /// takes nothing more does not take back a rename either.
  void look_at_the_folders() {
    (void)reconcile_results(*store_, folder_.path() / "results");
    for (const auto& entry : fs::directory_iterator(folder_.path() / "results")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with('.')) continue;
      try {
        if (store_->find(name).result_dir.empty()) wrong(name + " is no result");
      } catch (const Error& error) {
        wrong(name + ": " + error.what());
      }
    }
  }
  void wrong(const std::string& what) {
    ++violations_;
    ADD_FAILURE() << where_ << ": " << what;
  }
  void tell() const {
    std::cout << "{\"write_faults\": " << faults_ << ", \"write_fault_violations\": " << violations_ << "}"
              << std::endl;
  }

  const spdlog::level::level_enum level_;
  std::string where_;
  std::int64_t seq_ = 0;
  std::map<std::int64_t, JobState> told_;
  int faults_ = 0;
  int violations_ = 0;
};

TEST_F(AMachineOnABadDisk, TellsEveryFaultOfAFileAndGoesOn) {
  test::FaultyCalls calls(0, ENOSPC, test::FaultLasts::kUntilMended);
  calls.mend();
  const ReplacedFileCalls replaced(calls);
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  int turn = 0;
  bool reached = true;
  for (int call = 0; reached && violations_ < 20; call += all() ? 1 : 5) {
    const int reason = std::array{ENOSPC, EIO, EROFS}.at(static_cast<std::size_t>(turn++ % 3));
    where_ = "call " + std::to_string(call) + ", " + std::generic_category().message(reason);
    calls.arm(call, reason);
    if (const auto seq = start_refusably()) look_at_the_end(*seq);
    reached = calls.has_failed();
    calls.mend();
    look_at_the_machine();
    faults_ += reached ? 1 : 0;
  }
  engine_->finish();  // before the calls go
  look_at_the_folders();
  tell();
  EXPECT_GT(faults_, 10);
}

TEST_F(AMachineOnABadDisk, TellsEveryFaultOfTheDatabaseAndGoesOn) {
  test::BrokenDisk disk(EIO);
  disk.mend();
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  int turn = 0;
  bool reached = true;
  for (int write = 0; reached && violations_ < 20; write += all() ? 1 : 3) {
    const int reason = std::array{ENOSPC, EIO, EROFS}.at(static_cast<std::size_t>(turn++ % 3));
    where_ = "write " + std::to_string(write) + ", " + std::generic_category().message(reason);
    disk.break_again(reason, write);
    if (const auto seq = start_refusably()) look_at_the_end(*seq);
    reached = disk.has_failed();
    disk.mend();
    look_at_the_machine();
    faults_ += reached ? 1 : 0;
  }
  engine_->finish();
  look_at_the_folders();
  tell();
  EXPECT_GT(faults_, 3);
}

TEST_F(AMachineOnABadDisk, TellsEveryFaultOfASnap) {
  open();
  ASSERT_TRUE(await_state(ScanState::kInitialized));
  const fs::path snaps = folder_.path() / "snaps";
  bool reached = true;
  for (int call = 0; reached && violations_ < 20; ++call) {
    where_ = "call " + std::to_string(call);
    test::FaultyCalls calls(call, EIO, test::FaultLasts::kOnce);
    std::optional<ErrorCode> error;
    {
      const ReplacedFileCalls replaced(calls);
      const auto task = tasks().submit(snap_work({}), TaskMotion::kNone);
      if (!await_answer(*task)) return wrong("no answer");
      error = task->outcome()->error;
    }
    reached = calls.has_failed();
    if (error.has_value() != reached) wrong(reached ? "the fault is not told" : "it failed without a fault");
    faults_ += reached ? 1 : 0;
    if (reached && fs::exists(snaps) && !fs::is_empty(snaps)) wrong("a part of a picture is left");
    fs::remove_all(snaps);
  }
  tell();
  EXPECT_GT(faults_, 3);
}

}  // namespace
}  // namespace fvd
