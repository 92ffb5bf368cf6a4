#include "daemon/devices/left_threads.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <thread>

#include "daemon/devices/device_slot.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

TEST(WorkThatMayBeLeft, IsAwaitedWhileTheProcessLives) {
  std::atomic<int> done = 0;
  std::thread::id ran_on;
  EXPECT_TRUE(run_unless_process_ends("fvd-test", [&] {
    ran_on = std::this_thread::get_id();
    ++done;
  }));
  EXPECT_EQ(done, 1);
  EXPECT_NE(ran_on, std::this_thread::get_id());
  EXPECT_FALSE(left_a_thread());
}

TEST(WorkThatMayBeLeft, HandsItsExceptionOver) {
  EXPECT_THROW((void)run_unless_process_ends("fvd-test", [] { throw std::runtime_error("no camera"); }),
               std::runtime_error);
}

TEST(WorkThatMayBeLeftDeathTest, IsLeftWhenTheProcessEnds) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto end_of_a_process = [] {
    process_ends();
    const bool done = run_unless_process_ends("fvd-test", [] { std::this_thread::sleep_for(std::chrono::hours(1)); });
    std::_Exit(!done && left_a_thread() ? 7 : 1);
  };
  EXPECT_EXIT(end_of_a_process(), testing::ExitedWithCode(7), "");
}

/// What a device still tells while it is closed takes this long.
constexpr std::chrono::milliseconds kClosing{300};
std::atomic<bool> device_closed{false};

struct SlowToClose {
  ~SlowToClose() {
    std::this_thread::sleep_for(kClosing);
    device_closed = true;
  }
  [[nodiscard]] static bool connected() { return true; }
};

TEST(ASlotDeathTest, AwaitsAtTheEndOfTheProcessWhatTheNextOneWouldAwait) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto end_of_a_process = [](Predecessor predecessor) {
    {
      DeviceSlot<SlowToClose> slot([] { return std::make_unique<SlowToClose>(); }, ErrorCode::kStageDisconnected,
                                   predecessor, "fvd-reap-test");
      if (!slot.ensure()) std::_Exit(1);
      process_ends();
      slot.drop();
    }
    std::_Exit(device_closed && !left_a_thread() ? 7 : 8);
  };
  EXPECT_EXIT(end_of_a_process(Predecessor::kAwaited), testing::ExitedWithCode(7), "") << "a drive's watchdog";
  EXPECT_EXIT(end_of_a_process(Predecessor::kIgnored), testing::ExitedWithCode(8), "") << "a camera that is silent";
}

}  // namespace
}  // namespace fvd
