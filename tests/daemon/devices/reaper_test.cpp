#include "daemon/devices/reaper.hpp"

#include <atomic>
#include <future>
#include <thread>

#include "core/base/clock.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

struct Device {
  explicit Device(std::function<void()> closing) : closing_(std::move(closing)) {}
  ~Device() { closing_(); }
  std::function<void()> closing_;
};

TEST(Reaper, ClosesOnAnotherThreadWhileItsCallerGoesOn) {
  std::promise<void> go;
  std::promise<std::thread::id> closed_on;
  auto closed = closed_on.get_future();
  Reaper reaper("fvd-reap-camera");
  reaper.bury(std::make_unique<Device>([&] {
    go.get_future().wait_for(std::chrono::seconds(10));
    closed_on.set_value(std::this_thread::get_id());
  }));
  EXPECT_NE(closed.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  go.set_value();
  EXPECT_NE(closed.get(), std::this_thread::get_id());
}

TEST(Reaper, IsSeenToHangInADeviceThatCannotBeClosed) {
  std::promise<void> begun;
  std::promise<void> go;
  Reaper reaper("fvd-reap-camera");
  reaper.bury(std::make_unique<Device>([&] {
    begun.set_value();
    go.get_future().wait_for(std::chrono::seconds(10));
  }));
  begun.get_future().wait();
  EXPECT_TRUE(stalled_threads(HostClock::now() + std::chrono::minutes(4)).empty());
  const auto stalled = stalled_threads(HostClock::now() + std::chrono::minutes(6));
  ASSERT_EQ(stalled.size(), 1U);
  EXPECT_EQ(stalled.front().name, "fvd-reap-camera");
  go.set_value();
}

TEST(Reaper, EndsOnlyWhenEveryDeviceIsClosed) {
  std::atomic<int> closed = 0;
  {
    Reaper reaper("fvd-reap-camera");
    for (int i = 0; i < 50; ++i) reaper.bury(std::make_unique<Device>([&closed] { ++closed; }));
    reaper.bury(std::unique_ptr<Device>());
  }
  EXPECT_EQ(closed, 50);
}

}  // namespace
}  // namespace fvd
