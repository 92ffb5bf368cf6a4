#include "daemon/transport/worker.hpp"

#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace fvd {
namespace {

TEST(Worker, RunsTasksInTheirOrder) {
  std::vector<int> order;
  std::promise<void> last;
  Worker worker("test");
  for (int i = 0; i < 100; ++i) worker.post([&order, i] { order.push_back(i); });
  worker.post([&last] { last.set_value(); });
  last.get_future().wait();
  ASSERT_EQ(order.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST(Worker, EndsTheTaskThatRunsBeforeItGoes) {
  std::promise<void> begun;
  bool ended = false;
  const auto kept = std::make_shared<int>(0);
  {
    Worker worker("test");
    worker.post([&, kept] {
      begun.set_value();
      ended = true;
    });
    worker.post([kept] { ++*kept; });
    begun.get_future().wait();
  }
  EXPECT_TRUE(ended);
  EXPECT_EQ(kept.use_count(), 1) << "no task is left behind";
}

}  // namespace
}  // namespace fvd
