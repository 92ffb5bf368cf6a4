#include "core/runtime/worker_pool.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/clock.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "gtest/gtest.h"

namespace fvd {
namespace {

TEST(WorkerPool, CallsEveryIndexOnce) {
  for (const int threads : {1, 2, 4}) {
    WorkerPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const int count : {0, 1, 2, 3, 100}) {
      std::vector<std::atomic<int>> calls(100);
      pool.run(count, [&](int index) { ++calls[static_cast<std::size_t>(index)]; });
      for (int i = 0; i < 100; ++i) EXPECT_EQ(calls[static_cast<std::size_t>(i)], i < count ? 1 : 0);
    }
  }
}

TEST(WorkerPool, ForwardsAnExceptionAndStaysUsable) {
  WorkerPool pool(3);
  EXPECT_THROW(pool.run(50,
                        [](int index) {
                          if (index == 20) throw std::runtime_error("index 20");
                        }),
               std::runtime_error);
  std::atomic<int> calls{0};
  pool.run(10, [&](int) { ++calls; });
  EXPECT_EQ(calls, 10);
}

TEST(WorkerPool, HasThreadsThatAreSeenToHang) {
  WorkerPool pool(2);
  std::atomic<int> begun{0};
  std::atomic<bool> seen{false};
  pool.run(2, [&](int index) {
    for (++begun; begun < 2;) std::this_thread::yield();  // one index on each thread
    if (index == 1) {
      const auto stalled = stalled_threads(HostClock::now() + std::chrono::minutes(11));
      seen = stalled.size() == 1 && stalled.front().name == "fvd-worker";
      ++begun;
    }
    while (begun < 3) std::this_thread::yield();
  });
  EXPECT_TRUE(seen);
  EXPECT_TRUE(stalled_threads(HostClock::now()).empty());
}

TEST(WorkerPool, RunsLoopsInsideOfItsLoops) {
  for (const int threads : {1, 2, 4}) {
    WorkerPool pool(threads);
    std::vector<std::atomic<int>> calls(60);
    pool.run(6, [&](int outer) {
      pool.run(10, [&, outer](int inner) { ++calls[static_cast<std::size_t>(10 * outer + inner)]; });
    });
    for (const std::atomic<int>& call : calls) EXPECT_EQ(call, 1);
  }
}

TEST(WorkerPool, KeepsTheFailureOfAnInnerLoopFromItsNeighbour) {
  WorkerPool pool(2);
  std::atomic<int> failed{0};
  std::atomic<int> calls{0};
  pool.run(4, [&](int outer) {
    try {
      pool.run(5, [&, outer](int) {
        if (outer == 2) throw std::runtime_error("inner");
        ++calls;
      });
    } catch (const std::runtime_error&) {
      ++failed;
    }
  });
  EXPECT_EQ(failed, 1);
  EXPECT_EQ(calls, 15);
}

TEST(WorkerPool, ServesSeveralThreadsAtOnce) {
  WorkerPool pool(3);
  std::atomic<int> calls{0};
  {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 3; ++i) {
      callers.emplace_back([&] {
        for (int run = 0; run < 200; ++run) pool.run(4, [&](int) { ++calls; });
      });
    }
  }
  EXPECT_EQ(calls, 3 * 200 * 4);
}

TEST(WorkerPool, SurvivesManyShortRuns) {
  WorkerPool pool(2);
  std::atomic<int> calls{0};
  for (int i = 0; i < 2000; ++i) pool.run(2, [&](int) { ++calls; });
  EXPECT_EQ(calls, 4000);
}

}  // namespace
}  // namespace fvd
