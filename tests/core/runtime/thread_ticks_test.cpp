#include "core/runtime/thread_ticks.hpp"

#include <atomic>
#include <future>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fvd {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;

const HostTime kStart{std::chrono::hours(1)};

TEST(ThreadTicks, StallsOnceItsLastTickIsOlderThanAllowed) {
  ThreadTicks ticks("camera", milliseconds(500));
  ticks.tick(kStart);
  EXPECT_THAT(stalled_threads(kStart + milliseconds(500)), IsEmpty());
  EXPECT_THAT(stalled_threads(kStart + milliseconds(501)),
              ElementsAre(StalledThread{"camera", milliseconds(501), milliseconds(500)}));

  ticks.tick(kStart + milliseconds(600));
  EXPECT_THAT(stalled_threads(kStart + milliseconds(1100)), IsEmpty()) << "it got on";
  EXPECT_THAT(stalled_threads(kStart + milliseconds(1101)), testing::SizeIs(1));
}

TEST(ThreadTicks, MayTakeAsLongAsItSaidBeforeAStep) {
  ThreadTicks ticks("machine", milliseconds(500));
  ticks.tick(kStart, milliseconds(9000));
  EXPECT_THAT(stalled_threads(kStart + milliseconds(9000)), IsEmpty());
  EXPECT_THAT(stalled_threads(kStart + milliseconds(9001)),
              ElementsAre(StalledThread{"machine", milliseconds(9001), milliseconds(9000)}));
  ticks.tick(kStart + milliseconds(10000));
  EXPECT_THAT(stalled_threads(kStart + milliseconds(10501)), testing::SizeIs(1)) << "of that step alone";
}

TEST(ThreadTicks, DoesNotStallWhileItRests) {
  ThreadTicks ticks("camera", milliseconds(500));
  EXPECT_THAT(stalled_threads(kStart + std::chrono::hours(24)), IsEmpty()) << "before its first work";
  ticks.tick(kStart);
  ticks.rest();
  EXPECT_THAT(stalled_threads(kStart + std::chrono::hours(24)), IsEmpty());
}

TEST(ThreadTicks, NamesEveryThreadThatStallsAndNoOther) {
  ThreadTicks first("first", milliseconds(100));
  ThreadTicks good("good", milliseconds(1000));
  ThreadTicks last("last", milliseconds(200));
  for (ThreadTicks* ticks : {&first, &good, &last}) ticks->tick(kStart);
  std::vector<std::string> names;
  for (const StalledThread& stalled : stalled_threads(kStart + milliseconds(300))) names.push_back(stalled.name);
  EXPECT_THAT(names, ElementsAre("first", "last"));
}

TEST(ThreadTicks, IsForgottenWithItsThread) {
  {
    ThreadTicks ticks("short", milliseconds(100));
    ticks.tick(kStart);
    ASSERT_THAT(stalled_threads(kStart + milliseconds(200)), testing::SizeIs(1));
  }
  EXPECT_THAT(stalled_threads(kStart + milliseconds(200)), IsEmpty());
}

TEST(ThreadTicks, IsNotOlderThanNowWhenItTicksDuringTheLook) {
  ThreadTicks ticks("camera", milliseconds(500));
  ticks.tick(kStart + milliseconds(1));
  EXPECT_THAT(stalled_threads(kStart), IsEmpty());
}

TEST(ThreadTicks, DoesNotStallBetweenALongStepAndAShortOne) {
  ThreadTicks ticks("machine", milliseconds(10));
  std::atomic<HostTime> now{kStart};
  std::atomic<bool> is_over{false};
  std::atomic<int> looked = 0;
  auto looks = std::async(std::launch::async, [&] {
    std::size_t stalled = 0;
    for (; !is_over; ++looked) stalled += stalled_threads(now).size();
    return stalled;
  });
  constexpr int kLooks = 100;  // among many ticks each
  for (int i = 0; i < 200'000 || looked < kLooks; ++i) {
    ticks.tick(now, milliseconds(1000));
    now = now.load() + milliseconds(900);
    ticks.tick(now);
    now = now.load() + milliseconds(9);
  }
  is_over = true;
  EXPECT_EQ(looks.get(), 0U);
}

}  // namespace
}  // namespace fvd
