#include "daemon/devices/device_hub.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/runtime/thread_ticks.hpp"
#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

using Strings = std::vector<std::string>;

/// What the devices are told to be; it outlives them.
struct Cables {
  bool camera = true;
  bool axis = true;
  bool axis_moves = false;
  bool axis_stops = true;
  bool status_fails = false;
  std::optional<double> seen_um = std::nullopt;  ///< where the axis was seen last, by a driver that samples it
  bool seen_moving = false;
  std::chrono::hours seen_later{1};  ///< than now
  std::function<void()> on_axis_closing = nullptr;
};

class CabledCamera final : public sim::FakeCamera {
 public:
  CabledCamera(sim::FakeClock& clock, const Cables& cables) : FakeCamera(clock, 16, 12), cables_(cables) {}
  [[nodiscard]] bool connected() const noexcept override { return cables_.camera; }

 private:
  const Cables& cables_;
};

class CabledAxis final : public sim::FakeAxis {
 public:
  CabledAxis(sim::FakeClock& clock, Cables& cables) : FakeAxis(clock), cables_(cables) {}
  StageStatus status() override {
    if (!cables_.axis || cables_.status_fails) throw Error(ErrorCode::kStageDisconnected, "no answer");
    StageStatus status = FakeAxis::status();
    status.moving = cables_.axis_moves;
    return status;
  }
  ~CabledAxis() override {
    if (cables_.on_axis_closing) cables_.on_axis_closing();
  }
  [[nodiscard]] std::optional<StageStatus> last_seen() const override {
    if (!cables_.seen_um) return std::nullopt;
    StageStatus status;
    status.position = Micrometers{*cables_.seen_um};
    status.enabled = true;
    status.moving = cables_.seen_moving;
    status.sampled = HostClock::now() + cables_.seen_later;
    return status;
  }
  void stop() noexcept override { cables_.axis_moves = cables_.axis_moves && !cables_.axis_stops; }
  [[nodiscard]] bool connected() const noexcept override { return cables_.axis; }

 private:
  Cables& cables_;
};

class ADeviceHub : public testing::Test {
 protected:
  /// Opens as the machine's thread does: again and again while the device before is being closed.
  std::optional<DeviceFailure> open_after_closing() {
    for (;;) {
      auto failure = hub_.open();
      if (!failure || failure->message.find("still being closed") == std::string::npos) return failure;
      std::this_thread::yield();
    }
  }

  sim::FakeClock clock_;
  Cables cables_;
  Strings opened_;
  std::vector<bool> rest_;
  DeviceHub hub_{{.camera = [this]() -> std::unique_ptr<Camera> {
                    opened_.emplace_back("camera");
                    if (!cables_.camera) throw Error(ErrorCode::kCameraDisconnected, "no camera answers");
                    return std::make_unique<CabledCamera>(clock_, cables_);
                  },
                  .axis = [this]() -> std::unique_ptr<Axis> {
                    opened_.emplace_back("axis");
                    if (!cables_.axis) throw Error(ErrorCode::kStageDisconnected, "no stage answers");
                    return std::make_unique<CabledAxis>(clock_, cables_);
                  }},
                 clock_,
                 [this](bool at_rest) { rest_.push_back(at_rest); }};
};

TEST_F(ADeviceHub, OpensTheAxisFirstAndEachDeviceOnce) {
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(opened_, (Strings{"axis", "camera"}));
  EXPECT_EQ(hub_.openings(), 2);
  EXPECT_EQ(rest_, std::vector<bool>{true});
  EXPECT_EQ(hub_.facts().camera.sensor_height, 12);
}

TEST_F(ADeviceHub, TellsWhereTheAxisWasSeenAsLongAsItIsThere) {
  EXPECT_EQ(hub_.health().position, std::nullopt);
  cables_.seen_um = 0.0;
  ASSERT_EQ(hub_.open(), std::nullopt);
  ASSERT_TRUE(hub_.health().position.has_value());
  EXPECT_EQ(hub_.health().position->value, 0.0);
  cables_.axis = false;
  EXPECT_EQ(hub_.health().position, std::nullopt) << "it may be anywhere";
}

TEST_F(ADeviceHub, TellsHowFarTheAxisMayBeSentAsLongAsItIsThere) {
  EXPECT_FALSE(hub_.health().reach.has_value());
  ASSERT_EQ(hub_.open(), std::nullopt);
  ASSERT_TRUE(hub_.health().reach.has_value());
  EXPECT_EQ(hub_.health().reach->min.value, hub_.facts().stage.min.value);
  EXPECT_EQ(hub_.health().reach->max.value, hub_.facts().stage.max.value);
  cables_.axis = false;
  EXPECT_FALSE(hub_.health().reach.has_value());
}

TEST_F(ADeviceHub, SeesTheAxisStandByItsNewestSampleAlone) {
  EXPECT_FALSE(hub_.seen_standing()) << "there is none";
  cables_.seen_um = 0.0;
  ASSERT_EQ(hub_.open(), std::nullopt);
  EXPECT_TRUE(hub_.seen_standing());
  cables_.seen_moving = true;
  EXPECT_FALSE(hub_.seen_standing());
  EXPECT_TRUE(hub_.at_rest()) << "nobody has looked yet";
  cables_.seen_moving = false;
  cables_.seen_um = 50.0;
  EXPECT_FALSE(hub_.seen_standing()) << "it rested elsewhere";
  cables_.seen_um = 0.0;
  cables_.seen_later = std::chrono::hours(-1);
  EXPECT_FALSE(hub_.seen_standing()) << "that is long ago";
  cables_.seen_later = std::chrono::hours(1);
  EXPECT_TRUE(hub_.seen_standing());
  cables_.axis = false;
  EXPECT_FALSE(hub_.seen_standing()) << "nobody knows";
  cables_.axis = true;
  hub_.drop_all();
  EXPECT_FALSE(hub_.seen_standing()) << "it is given up";
}

TEST_F(ADeviceHub, CountsAnAxisThatNobodySamplesAsStanding) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  EXPECT_TRUE(hub_.seen_standing());
}

TEST_F(ADeviceHub, TellsBySlotWhoseClosingHangs) {
  std::promise<void> closing;
  std::promise<void> go;
  cables_.on_axis_closing = [&] {
    closing.set_value();
    go.get_future().wait_for(std::chrono::seconds(10));
  };
  ASSERT_EQ(hub_.open(), std::nullopt);
  hub_.drop_all();
  closing.get_future().wait();
  const auto stalled = stalled_threads(HostClock::now() + std::chrono::minutes(6));
  const auto is_stages = [](const StalledThread& thread) { return thread.name == "fvd-reap-stage"; };
  EXPECT_TRUE(std::any_of(stalled.begin(), stalled.end(), is_stages));
  go.set_value();
  ASSERT_EQ(open_after_closing(), std::nullopt);
  cables_.on_axis_closing = nullptr;
}

TEST_F(ADeviceHub, TriesAMissingDeviceAgainAndStopsTheAxisMeanwhile) {
  cables_.camera = false;
  cables_.axis_moves = true;
  EXPECT_EQ(hub_.open(), (DeviceFailure{ErrorCode::kCameraDisconnected, "no camera answers"}));
  EXPECT_FALSE(cables_.axis_moves);
  EXPECT_TRUE(hub_.at_rest());
  cables_.camera = true;
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(opened_, (Strings{"axis", "camera", "camera"}));
}

TEST_F(ADeviceHub, IsNotUsableWhileTheAxisMovesOn) {
  cables_.axis_moves = true;
  cables_.axis_stops = false;
  ASSERT_TRUE(hub_.open().has_value());
  EXPECT_EQ(hub_.open()->code, ErrorCode::kNotReady);
  EXPECT_FALSE(hub_.at_rest());
  EXPECT_TRUE(rest_.empty()) << "at rest is told when it is measured, and never was";
  cables_.axis_stops = true;
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(rest_, std::vector<bool>{true});
}

TEST_F(ADeviceHub, NamesTheAxisThatMovesBeforeTheCameraThatIsMissing) {
  cables_.axis_moves = true;
  cables_.axis_stops = false;
  cables_.camera = false;
  const auto failure = hub_.open();
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->code, ErrorCode::kNotReady) << failure->message;
}

TEST_F(ADeviceHub, NamesTheDeviceThatWasLostAndOpensItAnew) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(hub_.failure(), std::nullopt);
  cables_.camera = false;
  EXPECT_EQ(hub_.failure()->code, ErrorCode::kCameraDisconnected);
  EXPECT_TRUE(hub_.at_rest());
  cables_.axis = false;
  EXPECT_EQ(hub_.failure()->code, ErrorCode::kStageDisconnected);
  EXPECT_EQ(rest_, (std::vector<bool>{true, false})) << "an axis that cannot be seen is not at rest";
  cables_ = {};
  EXPECT_EQ(hub_.open(), std::nullopt) << "the fakes are connected again: the devices are the same";
  EXPECT_EQ(rest_, (std::vector<bool>{true, false, true}));
}

TEST_F(ADeviceHub, MeasuresStandstillAnewAfterEveryOpening) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(hub_.after_failure(ErrorCode::kStageDisconnected, "no answer"),
            (DeviceFailure{ErrorCode::kStageDisconnected, "no answer"}));
  EXPECT_FALSE(hub_.at_rest());
  cables_.axis_moves = true;
  EXPECT_EQ(open_after_closing(), std::nullopt);
  EXPECT_FALSE(cables_.axis_moves) << "it was found moving and stopped";
  EXPECT_EQ(rest_, (std::vector<bool>{true, false, true}));
}

TEST_F(ADeviceHub, GivesUpTheDeviceThatAnErrorNamesAndOpensNothing) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  opened_.clear();
  EXPECT_EQ(hub_.after_failure(ErrorCode::kCameraDisconnected, "pulled"),
            (DeviceFailure{ErrorCode::kCameraDisconnected, "pulled"}));
  EXPECT_TRUE(opened_.empty());
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(opened_, Strings{"camera"});
}

TEST_F(ADeviceHub, RenewsACameraThatLostFramesAtTheNextOpeningOnly) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  for (const ErrorCode code : {ErrorCode::kCameraFramesLost, ErrorCode::kCameraNoFrames}) {
    opened_.clear();
    EXPECT_EQ(hub_.after_failure(code, "no frames"), std::nullopt);
    EXPECT_TRUE(opened_.empty()) << "the end of the job is told first";
    EXPECT_EQ(hub_.open(), std::nullopt);
    EXPECT_EQ(opened_, Strings{"camera"});
  }
}

TEST_F(ADeviceHub, KeepsItsDevicesAfterAnErrorThatIsNotTheirs) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  opened_.clear();
  EXPECT_EQ(hub_.after_failure(ErrorCode::kStorageFull, "full"), std::nullopt);
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_TRUE(opened_.empty());
}

TEST_F(ADeviceHub, StopsAnAxisThatMovesAfterAnError) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  cables_.axis_moves = true;
  EXPECT_EQ(hub_.after_failure(ErrorCode::kStagePosition, "does not settle"), std::nullopt);
  EXPECT_FALSE(cables_.axis_moves);
  EXPECT_EQ(rest_, (std::vector<bool>{true, false, true})) << "seen moving, then at rest";
}

TEST_F(ADeviceHub, MeasuresAnewWhenAnAxisThatRestedIsSeenElsewhere) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  cables_.seen_um = 0.9;
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(rest_, std::vector<bool>{true}) << "the position dithers";
  cables_.seen_um = 7.0;
  cables_.axis_moves = true;
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_FALSE(cables_.axis_moves) << "moved by another master, and stopped";
  EXPECT_EQ(rest_, (std::vector<bool>{true, false, true}));
}

TEST_F(ADeviceHub, CannotBeUsedAfterAMotionThatDoesNotEnd) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  hub_.confirm_rest();
  EXPECT_EQ(hub_.failure(), std::nullopt);
  cables_.axis_moves = true;
  cables_.axis_stops = false;
  hub_.confirm_rest();
  EXPECT_FALSE(hub_.at_rest());
  ASSERT_TRUE(hub_.failure());
  EXPECT_EQ(hub_.failure()->code, ErrorCode::kNotReady);
  cables_.axis_stops = true;
  EXPECT_EQ(hub_.open(), std::nullopt);
  EXPECT_EQ(hub_.failure(), std::nullopt);
}

TEST_F(ADeviceHub, OpensNoAxisWhileTheOneBeforeIsStillBeingClosed) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  std::promise<void> go;
  std::promise<void> closing;
  cables_.on_axis_closing = [&] {
    closing.set_value();
    go.get_future().wait_for(std::chrono::seconds(10));
  };
  (void)hub_.after_failure(ErrorCode::kStageDisconnected, "no answer");
  closing.get_future().wait();
  cables_.on_axis_closing = nullptr;
  opened_.clear();
  const auto failure = hub_.open();
  ASSERT_TRUE(failure) << "what the old connection still sends would reach the new one's drive";
  EXPECT_EQ(failure->code, ErrorCode::kStageDisconnected);
  EXPECT_TRUE(opened_.empty());
  go.set_value();
  EXPECT_EQ(open_after_closing(), std::nullopt);
  EXPECT_EQ(opened_, Strings{"axis"});
}

TEST_F(ADeviceHub, GivesUpAnAxisThatStopsAnsweringWhileStandstillIsMeasured) {
  ASSERT_EQ(hub_.open(), std::nullopt);
  opened_.clear();
  cables_.status_fails = true;
  EXPECT_EQ(hub_.after_failure(ErrorCode::kAborted, "aborted")->code, ErrorCode::kStageDisconnected);
  EXPECT_FALSE(hub_.at_rest());
  cables_.status_fails = false;
  EXPECT_EQ(open_after_closing(), std::nullopt);
  EXPECT_EQ(opened_, Strings{"axis"});
}

}  // namespace
}  // namespace fvd
