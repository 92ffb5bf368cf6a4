#include "core/runtime/bounded_queue.hpp"

#include <memory>
#include <thread>

#include "gtest/gtest.h"
#include "tests/support/sleeping_thread.hpp"

namespace fvd {
namespace {

using std::chrono::steady_clock;

template <typename T>
bool push_now(BoundedQueue<T>& queue, T&& item) {
  return queue.push_until(std::move(item), steady_clock::time_point::min(), {});
}

TEST(BoundedQueue, RefusesWhenFullAndLeavesTheItemAlone) {
  BoundedQueue<std::unique_ptr<int>> queue(1);
  auto first = std::make_unique<int>(1);
  auto second = std::make_unique<int>(2);

  EXPECT_TRUE(push_now(queue, std::move(first)));
  EXPECT_FALSE(push_now(queue, std::move(second)));

  ASSERT_NE(second, nullptr);
  EXPECT_EQ(*second, 2);
}

TEST(BoundedQueue, KeepsTheOrderAcrossManyWraps) {
  BoundedQueue<int> queue(3);
  int expected = 0;
  for (int value = 0; value < 20; ++value) {
    ASSERT_TRUE(push_now(queue, int{value}));
    if (value % 2 == 1) {
      EXPECT_EQ(queue.pop({}), expected++);
      EXPECT_EQ(queue.pop({}), expected++);
    }
  }
}

TEST(BoundedQueue, DrainsAfterCloseAndThenEnds) {
  BoundedQueue<int> queue(2);
  ASSERT_TRUE(push_now(queue, 7));
  queue.close();
  EXPECT_FALSE(push_now(queue, 8));
  EXPECT_EQ(queue.pop({}), 7);
  EXPECT_FALSE(queue.pop({}).has_value());
}

TEST(BoundedQueue, WakesAWaitingConsumerOnStop) {
  BoundedQueue<int> queue(1);
  test::SleepingThread consumer([&queue](std::stop_token stop) { EXPECT_FALSE(queue.pop(stop).has_value()); });
  ASSERT_TRUE(consumer.sleeps());
  consumer.request_stop();
}

TEST(BoundedQueue, WakesAWaitingProducerOnStopAndOnClose) {
  BoundedQueue<int> queue(1);
  ASSERT_TRUE(push_now(queue, 1));
  const auto forever = steady_clock::now() + std::chrono::hours(1);
  {
    test::SleepingThread stopped([&](std::stop_token stop) { EXPECT_FALSE(queue.push_until(2, forever, stop)); });
    ASSERT_TRUE(stopped.sleeps());
    stopped.request_stop();
  }
  test::SleepingThread refused([&](std::stop_token) { EXPECT_FALSE(queue.push_until(3, forever, {})); });
  const bool slept = refused.sleeps();
  queue.close();
  EXPECT_TRUE(slept);
}

TEST(BoundedQueue, HandsEveryItemFromOneThreadToAnother) {
  BoundedQueue<int> queue(4);
  std::jthread producer([&queue] {
    for (int value = 0; value < 10000; ++value) {
      EXPECT_TRUE(queue.push_until(int{value}, steady_clock::time_point::max(), {}));
    }
    queue.close();
  });
  int expected = 0;
  while (auto value = queue.pop({})) EXPECT_EQ(*value, expected++);
  EXPECT_EQ(expected, 10000);
}

}  // namespace
}  // namespace fvd
