/// The driver against arv-fake-gv-camera, a camera of other authors: shows a misreading of the protocol that driver and
/// simulator might share. It is polled for triggers, cannot latch its clock, cannot resend, sends no test packets, and
/// drops the commands of strangers without a word.

#include <gtest/gtest.h>

#include "drivers/aravis/aravis_camera.hpp"
#include "drivers/aravis/gvcp_probe.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/network_namespace.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;

constexpr const char* kAddress = "127.0.0.1";  // the only one it takes

/// True once it answers.
bool is_there() {
  GvcpProbe probe(kAddress);
  const HostTime deadline = HostClock::now() + std::chrono::seconds(10);
  while (HostClock::now() < deadline) {
    const auto answer = probe.ask(milliseconds(100));
    if (answer == GvcpProbe::Answer::kFree) return true;
  }
  return false;
}

TEST(AravisFakeCamera, DeliversTriggeredFramesThroughTheDriver) {
  if (!test::enter_own_network()) GTEST_SKIP() << "this system does not allow a network namespace";
  const test::ChildProcess program({"arv-fake-gv-camera-0.8", "-i", kAddress});
  if (!is_there()) GTEST_SKIP() << "arv-fake-gv-camera-0.8 (Debian package aravis-tools) is not there";
  CameraConfig config;
  config.address = kAddress;
  config.packet_socket = false;
  const auto camera = open_aravis_camera(config);
  EXPECT_EQ(camera->info().vendor, "Aravis");
  EXPECT_FALSE(camera->info().simulated);
  CameraSettings settings;
  settings.width = 256;
  settings.height = 128;
  settings.exposure_us = 2000.0;
  const CameraSettings in_force = camera->configure(settings);
  EXPECT_EQ(in_force.width, 256);

  std::uint64_t last_id = 0;
  for (int i = 0; i < 10; ++i) {
    const HostTime triggered = HostClock::now();
    camera->trigger();
    const auto frame = camera->next_frame(HostClock::now() + camera->frame_deadline());
    ASSERT_TRUE(frame.has_value()) << "frame " << i;
    ASSERT_EQ(frame->status, FrameStatus::kOk);
    EXPECT_EQ(frame->image.width, 256);
    EXPECT_EQ(frame->image.height, 128);
    EXPECT_GT(frame->id, last_id);
    last_id = frame->id;
    EXPECT_LT(frame->exposure_start, HostClock::now());
    EXPECT_GT(frame->exposure_start, triggered - milliseconds(200)) << "its clock is known to a poll of its triggers";
  }
}

}  // namespace
}  // namespace fvd
