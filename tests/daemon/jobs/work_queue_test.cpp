#include "daemon/jobs/work_queue.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "gtest/gtest.h"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(WorkQueue, GivesWorkInTheOrderInWhichItCame) {
  WorkQueue queue;
  std::vector<int> done;
  for (const int i : {1, 2}) {
    ASSERT_TRUE(queue.post({.run = [&done, i] { done.push_back(i); }, .refuse = [] { FAIL(); }}));
  }
  for (int i = 0; i < 2; ++i) queue.take({}, milliseconds(0))->run();
  EXPECT_EQ(done, (std::vector<int>{1, 2}));
  EXPECT_FALSE(queue.take({}, milliseconds(0)).has_value());
}

TEST(WorkQueue, RefusesWhatWaitsOnceWhenItIsClosed) {
  WorkQueue queue;
  int refused = 0;
  ASSERT_TRUE(queue.post({.run = [] { FAIL(); }, .refuse = [&refused] { ++refused; }}));
  queue.close();
  queue.close();
  EXPECT_EQ(refused, 1);
  EXPECT_FALSE(queue.post({.run = [] { FAIL(); }, .refuse = [&refused] { ++refused; }}));
  EXPECT_EQ(refused, 1) << "what was not taken is its caller's to refuse";
}

TEST(WorkQueue, GivesNothingOnceAStopIsRequestedAndRefusesItLater) {
  WorkQueue queue;
  int refused = 0;
  ASSERT_TRUE(queue.post({.run = [] { FAIL(); }, .refuse = [&refused] { ++refused; }}));
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(queue.take(stop.get_token(), seconds(10)).has_value());
  queue.close();
  EXPECT_EQ(refused, 1);
}

TEST(WorkQueue, LosesNoWakeUp) {
  constexpr int kRounds = 20000;
  WorkQueue queue;
  std::atomic<int> done = 0;
  std::jthread taker([&](std::stop_token stop) {
    // Patience that only a lost wake-up uses up.
    while (done < kRounds) {
      const auto work = queue.take(stop, seconds(20));
      if (!work) return;
      work->run();
    }
  });
  for (int i = 0; i < kRounds; ++i) {
    ASSERT_TRUE(queue.post({.run = [&done] { ++done; }, .refuse = [] {}}));
    if (i % 3 == 0) {
      while (done <= i - 1) std::this_thread::yield();  // so that the taker waits again and again
    }
  }
  taker.join();
  EXPECT_EQ(done, kRounds);
}

TEST(WorkQueue, ClosesWhileWorkIsPostedAndEveryPieceEndsOnce) {
  for (int round = 0; round < 200; ++round) {
    WorkQueue queue;
    std::atomic<int> ended = 0;
    int refused_here = 0;
    std::jthread taker([&](std::stop_token stop) {
      while (const auto work = queue.take(stop, seconds(10))) work->run();
      queue.close();
    });
    for (int i = 0; i < 20; ++i) {
      if (i == round % 20) taker.request_stop();
      if (!queue.post({.run = [&ended] { ++ended; }, .refuse = [&ended] { ++ended; }})) ++refused_here;
    }
    taker.join();
    ASSERT_EQ(ended + refused_here, 20);
  }
}

}  // namespace
}  // namespace fvd
