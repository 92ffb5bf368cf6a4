/// Frames whose time cannot be right: the driver refuses them by name, measures the clock anew, and never waits for
/// them.

#include <cstdlib>

#include <gmock/gmock.h>

#include "drivers/aravis/camera_clock.hpp"
#include "tests/drivers/aravis/aravis_camera_fixture.hpp"

namespace fvd {
namespace {

using sim::CameraFault;
using test::AnAravisCamera;
using testing::HasSubstr;

/// The first good frame within four triggers, as a scan takes it.
std::optional<Frame> shoot_until_good(Camera& camera, int& refused) {
  for (int i = 0; i < 4; ++i) {
    const HostTime triggered = HostClock::now();
    camera.trigger();
    const HostTime deadline = HostClock::now() + camera.frame_deadline();
    while (auto frame = camera.next_frame(deadline)) {
      if (frame->status == FrameStatus::kMisdated) {
        ++refused;
        break;
      }
      if (frame->status == FrameStatus::kOk && frame->exposure_start >= triggered - std::chrono::milliseconds(1)) {
        return frame;
      }
    }
  }
  return std::nullopt;
}

class ACameraWhoseClockIsSet : public AnAravisCamera, public testing::WithParamInterface<int> {};

TEST_P(ACameraWhoseClockIsSet, DatesItsFramesRightSoonAfterwards) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  fault({.fault = CameraFault::kClockStep, .after = 2, .step = std::chrono::seconds(GetParam())});
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    const HostTime before = HostClock::now();
    const auto frame = shoot_until_good(*camera, refused);
    ASSERT_TRUE(frame.has_value()) << i;
    EXPECT_GE(frame->exposure_start, before - std::chrono::milliseconds(1)) << i;
    EXPECT_LE(frame->exposure_end, HostClock::now() + std::chrono::milliseconds(1)) << i;
  }
  EXPECT_EQ(server_->faults().unconsumed(), 0U);
}

INSTANTIATE_TEST_SUITE_P(BySeconds, ACameraWhoseClockIsSet, testing::Values(1, 3600, -1, -3600, 86'400, -86'400),
                         [](const auto& of) {
                           return std::string(of.param < 0 ? "Back" : "Ahead") + std::to_string(std::abs(of.param));
                         });

TEST_F(AnAravisCamera, RefusesAFrameOfTheFutureByName) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  fault({.fault = CameraFault::kOddTime, .step = std::chrono::hours(1)});
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->status, FrameStatus::kMisdated);
  EXPECT_THAT(camera->last_refusal(), HasSubstr("clock was set"));
  int refused = 0;
  const auto next = shoot_until_good(*camera, refused);
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(shows(*next, 2));
  camera->configure(settings());
  EXPECT_EQ(camera->last_refusal(), "");
}

TEST_F(AnAravisCamera, MeasuresItsClockWhileNothingIsAskedOfIt) {
  serve();
  const auto camera = open(1500, std::chrono::milliseconds(1));
  camera->configure(settings());
  // More commands than its heartbeats are in the time.
  fault({.fault = CameraFault::kClockStep,
         .on = sim::CameraEvent::kCommand,
         .after = 100,
         .step = std::chrono::milliseconds(1)});
  const HostTime deadline = HostClock::now() + std::chrono::seconds(20);
  while (server_->faults().unconsumed() > 0 && HostClock::now() < deadline) camera->look_after();
  EXPECT_EQ(server_->faults().unconsumed(), 0U);
}

TEST(ACameraClock, StaysWithinAMonthOfItsLatestPair) {
  CameraClock clock(std::chrono::seconds(5));
  const HostTime now = HostClock::now();
  clock.add({1'000'000'000'000, now, {}});
  for (const std::uint64_t senseless : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 63U}) {
    const auto host = clock.to_host(senseless);
    ASSERT_TRUE(host.has_value());
    EXPECT_LE(std::chrono::abs(*host - now), std::chrono::hours(24 * 31)) << senseless;
  }
}

TEST(ACameraClock, IsDueSoonFromHalfItsAgeOn) {
  CameraClock clock(std::chrono::seconds(4));
  const HostTime now = HostClock::now();
  EXPECT_TRUE(clock.due_soon(now)) << "before the first";
  clock.add({1'000'000'000'000, now, {}});
  EXPECT_FALSE(clock.due_soon(now + std::chrono::seconds(2)));
  EXPECT_TRUE(clock.due_soon(now + std::chrono::milliseconds(2001)));
  EXPECT_FALSE(clock.due(now + std::chrono::seconds(4)));
  EXPECT_TRUE(clock.due(now + std::chrono::milliseconds(4001)));
  clock.add({3'000'000'000'000, now + std::chrono::seconds(2), {}});
  EXPECT_FALSE(clock.due_soon(now + std::chrono::seconds(4)));
}

TEST(ACameraClock, IsDueAgainWhenDoubted) {
  CameraClock clock(std::chrono::hours(1));
  const HostTime now = HostClock::now();
  clock.add({1'000'000'000'000, now, {}});
  EXPECT_FALSE(clock.due(now + std::chrono::seconds(1)));
  clock.doubt();
  EXPECT_TRUE(clock.due(now + std::chrono::seconds(1)));
  clock.add({2'000'000'000'000, now + std::chrono::seconds(1), {}});
  EXPECT_FALSE(clock.due(now + std::chrono::seconds(2)));
}

}  // namespace
}  // namespace fvd
