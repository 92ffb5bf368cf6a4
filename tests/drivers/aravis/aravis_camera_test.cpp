/// The Aravis driver against the simulated camera, over real GVCP and GVSP: opening, settings, loss, interruption.

#include <gmock/gmock.h>

#include "drivers/aravis/gvcp_probe.hpp"
#include "tests/drivers/aravis/aravis_camera_fixture.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using test::AnAravisCamera;
using testing::AllOf;
using testing::HasSubstr;

TEST_F(AnAravisCamera, TellsWhoItIs) {
  serve();
  const auto camera = open();
  const CameraInfo info = camera->info();
  EXPECT_EQ(info.vendor, "fvd");
  EXPECT_EQ(info.model, "SimulatedCamera");
  EXPECT_EQ(info.serial, "SIM01");
  EXPECT_EQ(info.sensor_width, 320);
  EXPECT_EQ(info.sensor_height, 200);
  EXPECT_TRUE(info.simulated);
}

TEST_F(AnAravisCamera, RefusesSettingsOutOfRangeWithTheRange) {
  serve();
  const auto camera = open();
  CameraSettings wrong = settings();
  wrong.exposure_us = 1.0;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wrong),
                          AllOf(HasSubstr("ExposureTime"), HasSubstr("10 to 10000000")));
  wrong = settings();
  wrong.width = 5000;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wrong), HasSubstr("Width"));
  wrong = settings();
  wrong.width = 300;
  wrong.offset_x = 100;
  FVD_EXPECT_ERROR(kCameraSettings, camera->configure(wrong));
  EXPECT_NO_THROW(camera->configure(settings()));
  EXPECT_TRUE(shoot(*camera).has_value());
}

TEST_F(AnAravisCamera, RefusesToShareControl) {
  serve();
  GvcpProbe other(address_);
  ASSERT_FALSE(other.control_denied(std::chrono::seconds(5))) << "nobody controls it yet";
  const test::Controller controller(address_);
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open(), HasSubstr("another program"));
}

TEST_F(AnAravisCamera, NoticesADeadCameraAndWorksAgainOnceItIsBack) {
  serve();
  auto camera = open();
  camera->configure(settings());
  ASSERT_TRUE(shoot(*camera).has_value());
  server_.reset();
  const HostTime died = HostClock::now();
  FVD_EXPECT_ERROR(kCameraDisconnected, for (int i = 0; i < 4; ++i)(void) shoot(*camera));
  EXPECT_LT(HostClock::now() - died, std::chrono::seconds(4));
  EXPECT_FALSE(camera->connected());
  serve();
  auto again = open();
  again->configure(settings());
  EXPECT_TRUE(shoot(*again).has_value());
  camera.reset();
}

TEST_F(AnAravisCamera, SaysWhereItFoundNoCamera) {
  FVD_EXPECT_ERROR_SAYING(kCameraDisconnected, (void)open(), HasSubstr(address_));
}

TEST_F(AnAravisCamera, EndsAWaitWhenInterrupted) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  camera->interrupt();
  EXPECT_FALSE(camera->next_frame(HostClock::now() + std::chrono::hours(1)).has_value());
}

TEST_F(AnAravisCamera, LosesNoFrameToALongerExposure) {
  serve();
  const auto camera = open();
  for (const TriggerMode trigger : {TriggerMode::kSoftware, TriggerMode::kLine}) {
    for (const double exposure_us : {1'000.0, 30'000.0, 2'000.0, 100'000.0}) {
      CameraSettings changed = settings();
      changed.trigger = trigger;
      changed.exposure_us = exposure_us;
      camera->configure(changed);
      for (int i = 0; i < 2; ++i) {
        trigger == TriggerMode::kLine ? server_->pulse_line() : camera->trigger();
        const auto frame = camera->next_frame(HostClock::now() + camera->frame_deadline());
        ASSERT_TRUE(frame.has_value()) << exposure_us << " us, frame " << i;
        EXPECT_EQ(frame->status, FrameStatus::kOk) << exposure_us << " us, frame " << i;
      }
    }
  }
}

/// A job that was stopped after its last frame must not cost the next one its first.
TEST_F(AnAravisCamera, ForgetsAnInterruptOfBeforeItWasConfigured) {
  serve();
  const auto camera = open();
  CameraSettings by_line = settings();
  by_line.trigger = TriggerMode::kLine;
  by_line.exposure_us = 100'000.0;  // the frame is waited for long enough to see an interrupt
  camera->configure(by_line);
  server_->pulse_line();
  (void)camera->next_frame(HostClock::now() + camera->frame_deadline());
  camera->interrupt();
  camera->configure(by_line);
  server_->pulse_line();
  const auto frame = camera->next_frame(HostClock::now() + camera->frame_deadline());
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->status, FrameStatus::kOk);
}

}  // namespace
}  // namespace fvd
