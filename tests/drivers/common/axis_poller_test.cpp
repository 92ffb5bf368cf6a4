/// Who waits for a sample gets one, or an error, whatever becomes of the thread that takes them.

#include "drivers/common/axis_poller.hpp"

#include <atomic>
#include <deque>
#include <future>
#include <stdexcept>

#include <spdlog/spdlog.h>

#include "drivers/common/axis_stopper.hpp"
#include "gtest/gtest.h"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::expect_error;

constexpr Micrometers kMin{-1000.0};
constexpr Micrometers kMax{1000.0};

/// Answers until it is told otherwise.
class ScriptedPort final : public AxisPort {
 public:
  enum class Mode { kAnswers, kSilent, kThrows };

  ScriptedPort() {
    traits_.address = "the fake";
    traits_.sample_timeout = milliseconds(150);
  }
  [[nodiscard]] const AxisTraits& traits() const override { return traits_; }
  [[nodiscard]] std::optional<AxisSample> sample(std::string& error) override {
    if (mode == Mode::kThrows) throw std::runtime_error("out of luck");
    if (mode == Mode::kSilent) {
      error = "no answer";
      return std::nullopt;
    }
    AxisSample sample;
    sample.begun = sample.time = HostClock::now();
    sample.moving = moving;
    sample.position = Micrometers{speed_um_per_s * std::chrono::duration<double>(sample.time - born_).count()};
    if (script.empty()) return sample;
    sample.position = Micrometers{script.front()};
    if (script.size() > 1) script.pop_front();
    return sample;
  }
  [[nodiscard]] CommandResult enable(const MotionLimits& /*limits*/, std::stop_token /*stop*/) override { return {}; }
  [[nodiscard]] CommandResult home(const MotionLimits& /*limits*/, std::stop_token /*stop*/) override { return {}; }
  [[nodiscard]] CommandResult move(StageCounts /*target*/, const MotionLimits& /*limits*/,
                                   std::stop_token /*stop*/) override {
    return {};
  }
  [[nodiscard]] CommandResult stop() override {
    if (const AxisPoller* const seen = poller; seen != nullptr) connected_at_stop = seen->connected();
    ++stops;
    if (busy) return {CommandOutcome::kUnknown, "exception 6: busy", true};
    return {};
  }
  [[nodiscard]] std::optional<ForeignWrite> foreign_write(std::stop_token /*stop*/) override {
    if (!another_writes.exchange(false)) return std::nullopt;
    return ForeignWrite{"'target' reads 7, and fvd wrote 5"};
  }
  [[nodiscard]] std::string alarm_text(int /*code*/) const override { return "alarm"; }

  std::atomic<Mode> mode{Mode::kAnswers};
  std::deque<double> script;  ///< positions, um; the last again and again. Changed in a pause only
  double speed_um_per_s = 0.0;
  std::atomic<bool> moving{false};
  std::atomic<bool> another_writes{false};
  std::atomic<bool> busy{false};
  std::atomic<int> stops{0};
  std::atomic<bool> connected_at_stop{true};
  std::atomic<AxisPoller*> poller{nullptr};

 private:
  const HostTime born_ = HostClock::now();
  AxisTraits traits_;
};

TEST(AxisPoller, BelievesAJumpThatASecondReadingConfirms) {
  ScriptedPort port;
  port.script = {0.0, 5000.0, 5000.1};
  AxisPoller poller(port, 1000.0, kMin, kMax);
  EXPECT_DOUBLE_EQ(poller.sample_after(HostClock::now(), {}).position.value, 5000.1);
  EXPECT_EQ(poller.implausible(), 1U);
}

TEST(AxisPoller, TakesASampleAtOnceForWhoAsks) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  const HostTime from = HostClock::now();
  for (int i = 0; i < 200; ++i) {
    const HostTime asked = HostClock::now();
    EXPECT_GT(poller.sample_now({}).begun, asked);
  }
  spdlog::info("a sample is there after {} us", (HostClock::now() - from) / std::chrono::microseconds(200));
  port.mode = ScriptedPort::Mode::kSilent;
  expect_error(ErrorCode::kStageDisconnected, {"the fake", "no answer"}, [&] {
    for (;;) (void)poller.sample_now({});
  });
}

TEST(AxisPoller, BelievesAFirstPositionFarOutsideTheLimitsOnlyIfASecondReadingAgrees) {
  ScriptedPort wrong;
  wrong.script = {65536.0, 0.5};
  AxisPoller once(wrong, 1000.0, kMin, kMax);
  EXPECT_DOUBLE_EQ(once.latest().position.value, 0.5);
  EXPECT_EQ(once.implausible(), 1U);

  ScriptedPort far;
  far.script = {65536.0, 65536.1};
  AxisPoller twice(far, 1000.0, kMin, kMax);
  EXPECT_DOUBLE_EQ(twice.latest().position.value, 65536.1) << "before homing the counter may stand anywhere";

  ScriptedPort near;
  near.script = {2900.0};
  AxisPoller inside(near, 1000.0, kMin, kMax);
  EXPECT_EQ(inside.implausible(), 0U) << "limits leave room";
}

TEST(AxisPoller, TellsWhatAnotherMasterWroteForAWhile) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  EXPECT_FALSE(poller.foreign_write(true));
  port.another_writes = true;
  while (!poller.foreign_write(false)) std::this_thread::yield();
  EXPECT_TRUE(poller.foreign_write(true)) << "he may still be there";
}

TEST(AxisPoller, FollowsAnAxisThatIsMuchFasterThanItIsCommandedToBe) {
  ScriptedPort port;
  port.speed_um_per_s = 1e6;
  AxisPoller poller(port, 1.0, kMin, kMax);
  for (int i = 0; i < 20; ++i) EXPECT_NO_THROW((void)poller.sample_after(HostClock::now(), {}));
  EXPECT_TRUE(poller.connected());
}

TEST(AxisPoller, BelievesNeitherOfTwoReadingsThatContradictOneAnother) {
  ScriptedPort port;
  port.script = {0.0, 5000.0, -7000.0, 0.2};
  AxisPoller poller(port, 1000.0, kMin, kMax);
  EXPECT_DOUBLE_EQ(poller.sample_after(HostClock::now(), {}).position.value, 0.2);
  EXPECT_EQ(poller.implausible(), 2U);
}

TEST(AxisPoller, GivesUpAnAxisWhosePositionsMakeNoSense) {
  ScriptedPort port;
  port.moving = true;
  port.script = {0.0, 1e4, -1e4, 2e4, -2e4, 3e4, 0.0};
  AxisPoller poller(port, 1000.0, kMin, kMax);
  expect_error(ErrorCode::kStageDisconnected, {"the fake", "contradict"},
               [&] { (void)poller.sample_after(HostClock::now(), {}); });
  while (port.stops == 0) std::this_thread::yield();
}

TEST(AxisPoller, GivesSamplesThatWereBegunAfterTheQuestion) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  for (int i = 0; i < 20; ++i) {
    const HostTime asked = HostClock::now();
    EXPECT_GT(poller.sample_after(asked, {}).begun, asked);
  }
}

TEST(AxisPoller, TellsWaitersOfALossAndOnlyThenStopsTheAxis) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  port.poller = &poller;
  port.moving = true;
  (void)poller.sample_after(HostClock::now(), {});
  port.mode = ScriptedPort::Mode::kSilent;
  expect_error(ErrorCode::kStageDisconnected, {"the fake", "no answer"},
               [&] { (void)poller.sample_after(HostClock::now() + milliseconds(50), {}); });
  EXPECT_FALSE(poller.connected());
  while (port.stops == 0) std::this_thread::yield();
  EXPECT_FALSE(port.connected_at_stop) << "who looks while the stop is on its way must see the loss";
}

TEST(AxisPoller, TellsWaitersThatItsThreadHasEndedByAnException) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  (void)poller.sample_after(HostClock::now(), {});
  port.mode = ScriptedPort::Mode::kThrows;
  expect_error(ErrorCode::kStageDisconnected, {"out of luck"},
               [&] { (void)poller.sample_after(HostClock::now() + milliseconds(20), {}); });
  EXPECT_FALSE(poller.connected());
  EXPECT_EQ(port.stops, 0) << "it did not move";
}

TEST(AxisPoller, LetsNobodyWaitForEver) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  poller.pause([&] {
    const HostTime asked = HostClock::now();
    expect_error(ErrorCode::kStageDisconnected, {"in time"}, [&] { (void)poller.sample_after(asked, {}); });
    EXPECT_LT(HostClock::now() - asked, std::chrono::seconds(5));
  });
  EXPECT_NO_THROW((void)poller.sample_after(HostClock::now(), {}));
}

TEST(AxisPoller, EndsAWaitOnAStopRequest) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  std::stop_source stop;
  auto waiter = std::async(std::launch::async, [&] {
    return test::name_of(
        test::error_of([&] { (void)poller.sample_after(HostClock::now() + std::chrono::hours(1), stop.get_token()); }));
  });
  stop.request_stop();
  EXPECT_EQ(waiter.get(), "aborted");
}

TEST(AxisPoller, TakesNoSampleInAPause) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  (void)poller.sample_after(HostClock::now(), {});
  poller.pause([&] {
    const HostTime before = poller.latest().begun;
    expect_error(ErrorCode::kStageDisconnected, {}, [&] { (void)poller.sample_after(HostClock::now(), {}); });
    EXPECT_EQ(poller.latest().begun, before);
  });
}

TEST(AxisStopper, SendsNoSecondStopToADriveThatWasBusyForAsLongAsItMay) {
  ScriptedPort port;
  AxisPoller poller(port, 1000.0, kMin, kMax);
  AxisStopper stopper(port, poller, {1000.0, 10000.0});
  port.busy = true;
  EXPECT_NE(stopper.send(), "");
  EXPECT_EQ(port.stops, 1);
}

}  // namespace
}  // namespace fvd
