#include "daemon/jobs/jog.hpp"

#include <chrono>
#include <future>

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include "core/runtime/guarded_thread.hpp"
#include "daemon/jobs/objective_limits.hpp"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;

/// Sweeps until it is stopped, as a long way does.
class SweepingAxis final : public sim::FakeAxis {
 public:
  using FakeAxis::FakeAxis;
  MoveRecord sweep_to(Micrometers target, double speed_um_per_s, std::stop_token stop) override {
    targets_um.push_back(target.value);
    speed = speed_um_per_s;
    began.set_value();
    Mutex mutex;
    Condition never;
    MutexLock lock(mutex);
    (void)never.wait_for(lock, stop, std::chrono::seconds(20), [] { return false; });
    ended = HostClock::now();
    if (stop.stop_requested()) throw Error(ErrorCode::kAborted, "stopped");
    return {};
  }
  std::promise<void> began;
  HostTime ended{};
  double speed = 0.0;  ///< um/s, of the last sweep
};

class AJog : public testing::Test {
 protected:
  static JogRequest request(milliseconds from_now = milliseconds(150), bool up = true) {
    return {up, 100.0, HostClock::now() + from_now, "token page"};
  }
  /// Runs the jog on a thread of its own.
  void begin(const JogRequest& request) {
    hold_ = std::make_shared<JogHold>(request);
    task_ = jog_task(hold_);
    thread_ = start_thread("jog", [this](const std::stop_token&) {
      task_->run({camera_, axis_, clock_, "", objective_}, stop_.get_token());
    });
    axis_.began.get_future().wait();
  }
  void end() { thread_.join(); }

  sim::FakeClock clock_;
  sim::FakeCamera camera_{clock_, 16, 16};
  SweepingAxis axis_{clock_};
  const ObjectiveConfig* objective_ = nullptr;
  std::stop_source stop_;
  std::shared_ptr<JogHold> hold_;
  std::shared_ptr<DeviceTask> task_;
  std::jthread thread_;
};

TEST_F(AJog, EndsByItself) {
  const JogRequest asked = request(milliseconds(100));
  begin(asked);
  end();
  EXPECT_GE(axis_.ended, asked.until);
  EXPECT_FALSE(task_->outcome()->error) << task_->outcome()->message;
  EXPECT_EQ(axis_.targets_um, std::vector<double>{499.99}) << "the upper limit, by one step inside";
  EXPECT_FALSE(hold_->extend(request())) << "it is over: a new one has to begin";
  spdlog::info("a jog ended {} us after its time", (axis_.ended - asked.until) / std::chrono::microseconds(1));
}

TEST_F(AJog, IsNoFasterThanItCanBeHaltedFromSoon) {
  axis_.description.speed_um_per_s = 1000.0;
  axis_.description.acceleration_um_per_s2 = 2000.0;
  begin(request(milliseconds(20)));
  end();
  EXPECT_DOUBLE_EQ(axis_.speed, 80.0) << "40 ms at that acceleration";
}

TEST_F(AJog, OfASpeedThatTheAxisHasNotIsLeftToTheAxisToRefuse) {
  axis_.description.speed_um_per_s = 50.0;
  axis_.description.acceleration_um_per_s2 = 2000.0;
  begin(request(milliseconds(20)));
  end();
  EXPECT_DOUBLE_EQ(axis_.speed, 100.0);
}

TEST_F(AJog, GoesOnWhileItIsRepeated) {
  begin(request(milliseconds(2000), false));
  JogRequest last = request(milliseconds(4000), false);
  EXPECT_TRUE(hold_->extend(last));
  EXPECT_TRUE(hold_->extend(request(milliseconds(10), false))) << "an earlier end does not count";
  JogRequest others = request(milliseconds(9000), false);
  others.who = "token other";
  EXPECT_FALSE(hold_->extend(others)) << "another's jog ends this one";
  end();
  EXPECT_LT(axis_.ended, last.until);
  EXPECT_EQ(axis_.targets_um, std::vector<double>{-499.99});
}

TEST_F(AJog, KeepsToTheObjectivesLimits) {
  const ObjectiveConfig objective{"50x", 0.5, 50.0, 3.1, -100.0, 50.0};
  objective_ = &objective;
  begin(request(milliseconds(20)));
  end();
  EXPECT_EQ(axis_.targets_um, std::vector<double>{49.99});
}

TEST_F(AJog, EndsWithAStopAndSaysSo) {
  begin(request(milliseconds(10000)));
  stop_.request_stop();
  end();
  EXPECT_EQ(task_->outcome()->error, ErrorCode::kAborted);
  const auto told = hold_->take_failure(request());
  ASSERT_TRUE(told);
  EXPECT_EQ(told->code(), ErrorCode::kAborted);
  JogRequest other_way = request(milliseconds(150), false);
  EXPECT_TRUE(hold_->take_failure(other_way)) << "a stop holds for all that its caller goes on asking";
  EXPECT_TRUE(hold_->take_failure(request()));
  other_way.who = "token other";
  EXPECT_FALSE(hold_->take_failure(other_way)) << "another may begin";
}

TEST_F(AJog, IsOverWhenItsTimeIsThoughItNeverBegan) {
  hold_ = std::make_shared<JogHold>(request(milliseconds(0)));
  EXPECT_FALSE(hold_->extend(request())) << "nothing moves that could go on";
  jog_task(hold_)->fail(ErrorCode::kNotReady, "no stage is plugged in");
  const auto told = hold_->take_failure(request());
  ASSERT_TRUE(told);
  EXPECT_EQ(told->code(), ErrorCode::kNotReady);
}

TEST_F(AJog, MovesNothingAtItsLimit) {
  axis_.description.max = Micrometers{0.0};  // where the fake stands
  hold_ = std::make_shared<JogHold>(request());
  task_ = jog_task(hold_);
  task_->run({camera_, axis_, clock_, "", nullptr}, {});
  EXPECT_EQ(task_->outcome()->error, ErrorCode::kStageLimit);
  EXPECT_TRUE(axis_.targets_um.empty());
  JogRequest others = request();
  others.who = "token other";
  EXPECT_FALSE(hold_->take_failure(others)) << "it is nobody else's news";
}

}  // namespace
}  // namespace fvd
