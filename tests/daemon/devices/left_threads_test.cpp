#include "daemon/devices/left_threads.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

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

}  // namespace
}  // namespace fvd
