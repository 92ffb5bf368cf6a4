#include "core/pipeline/bounded_queue.hpp"

#include <memory>
#include <thread>

#include "gtest/gtest.h"

namespace fvd {
namespace {

TEST(BoundedQueue, RefusesWhenFullAndLeavesTheItemAlone) {
  BoundedQueue<std::unique_ptr<int>> queue(1);
  auto first = std::make_unique<int>(1);
  auto second = std::make_unique<int>(2);

  EXPECT_TRUE(queue.try_push(std::move(first)));
  EXPECT_FALSE(queue.try_push(std::move(second)));

  ASSERT_NE(second, nullptr);
  EXPECT_EQ(*second, 2);
}

TEST(BoundedQueue, KeepsTheOrderAcrossManyWraps) {
  BoundedQueue<int> queue(3);
  int expected = 0;
  for (int value = 0; value < 20; ++value) {
    ASSERT_TRUE(queue.try_push(int{value}));
    if (value % 2 == 1) {
      EXPECT_EQ(queue.pop({}), expected++);
      EXPECT_EQ(queue.pop({}), expected++);
    }
  }
}

TEST(BoundedQueue, DrainsAfterCloseAndThenEnds) {
  BoundedQueue<int> queue(2);
  ASSERT_TRUE(queue.try_push(7));
  queue.close();
  EXPECT_FALSE(queue.try_push(8));
  EXPECT_EQ(queue.pop({}), 7);
  EXPECT_FALSE(queue.pop({}).has_value());
}

TEST(BoundedQueue, WakesAWaitingConsumerOnStop) {
  BoundedQueue<int> queue(1);
  std::jthread consumer([&queue](std::stop_token stop) { EXPECT_FALSE(queue.pop(stop).has_value()); });
  consumer.request_stop();
}

TEST(BoundedQueue, HandsEveryItemFromOneThreadToAnother) {
  BoundedQueue<int> queue(4);
  std::jthread producer([&queue] {
    for (int value = 0; value < 10000;) {
      if (queue.try_push(int{value})) {
        ++value;
      } else {
        std::this_thread::yield();
      }
    }
    queue.close();
  });
  int expected = 0;
  while (auto value = queue.pop({})) EXPECT_EQ(*value, expected++);
  EXPECT_EQ(expected, 10000);
}

}  // namespace
}  // namespace fvd
