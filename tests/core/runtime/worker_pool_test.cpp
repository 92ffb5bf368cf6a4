#include "core/runtime/worker_pool.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

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

TEST(WorkerPool, SurvivesManyShortRuns) {
  WorkerPool pool(2);
  std::atomic<int> calls{0};
  for (int i = 0; i < 2000; ++i) pool.run(2, [&](int) { ++calls; });
  EXPECT_EQ(calls, 4000);
}

}  // namespace
}  // namespace fvd
