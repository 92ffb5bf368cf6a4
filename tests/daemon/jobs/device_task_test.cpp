/// A command's answer, and who sees it in which order.

#include "daemon/jobs/device_task.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(DeviceTask, NotesItsAnswerOnceBeforeItGivesIt) {
  DeviceTask task{DeviceTask::Work{}};
  std::atomic<bool> noted{false};
  std::promise<void> seen;
  auto is_seen = seen.get_future();
  task.note_outcome([&](const DeviceTask::Outcome& outcome) {
    EXPECT_EQ(outcome.json, "{}");
    (void)is_seen.wait_for(std::chrono::milliseconds(100));  // for whoever would be too early
    noted = true;
  });
  auto caller = std::async(std::launch::async, [&] {
    while (!task.outcome()) {
      std::this_thread::yield();
    }
    const bool in_time = noted;
    seen.set_value();
    return in_time;
  });
  task.end({"{}", std::nullopt, {}});
  EXPECT_TRUE(caller.get());
}

TEST(DeviceTask, NotesTheFirstOfTwoAnswers) {
  DeviceTask task{DeviceTask::Work{}};
  std::vector<std::string> noted;
  const auto note = [&noted](const DeviceTask::Outcome& outcome) { noted.push_back(outcome.json + outcome.message); };
  task.note_outcome(note);
  task.end({"first", std::nullopt, {}});
  task.fail(ErrorCode::kAborted, "second");
  EXPECT_EQ(task.outcome().value().json, "first");
  task.note_outcome(note);
  EXPECT_EQ(noted, (std::vector<std::string>{"first", "first"})) << "who comes late is told at once";
}

}  // namespace
}  // namespace fvd
