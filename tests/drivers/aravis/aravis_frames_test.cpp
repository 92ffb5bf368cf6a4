/// The Aravis driver against the simulated camera, over real GVCP and GVSP: the frames that come, in every format and
/// order.

#include <vector>

#include "drivers/aravis/frame_counter.hpp"
#include "tests/drivers/aravis/aravis_camera_fixture.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

using std::chrono::milliseconds;
using test::AnAravisCamera;
using test::CountingSource;

TEST_F(AnAravisCamera, DeliversEveryTriggeredFrameInOrder) {
  serve();
  const auto camera = open();
  const CameraSettings effective = camera->configure(settings());
  EXPECT_EQ(effective.width, 320);
  EXPECT_EQ(effective.height, 200);
  std::uint64_t last_id = 0;
  for (std::uint64_t i = 1; i <= 100; ++i) {
    const HostTime before = HostClock::now();
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame.has_value()) << i;
    ASSERT_EQ(frame->status, FrameStatus::kOk) << i;
    EXPECT_TRUE(shows(*frame, i)) << "exposure 0 was the warm-up";
    EXPECT_GT(frame->id, last_id);
    EXPECT_GE(frame->exposure_start, before - std::chrono::microseconds(200));
    EXPECT_LE(frame->exposure_end, HostClock::now() + std::chrono::microseconds(200));
    last_id = frame->id;
  }
  EXPECT_EQ(camera->health().underruns, 0U);
}

/// The device's thread renews what is known of the clock while frames are taken; the thread sanitizer watches.
TEST_F(AnAravisCamera, RenewsItsClockWhileFramesAreTaken) {
  serve();
  const auto camera = open(1500, milliseconds(1));
  CameraSettings running = settings();
  (void)camera->configure(running);
  running.trigger = TriggerMode::kFreeRun;
  running.frame_rate_hz = 200.0;
  (void)camera->configure(running);
  HostTime last = HostTime::min();
  for (int i = 0; i < 300; ++i) {
    const auto frame = camera->next_frame(HostClock::now() + camera->frame_deadline());
    ASSERT_TRUE(frame.has_value()) << i;
    ASSERT_EQ(frame->status, FrameStatus::kOk) << i;
    EXPECT_GT(frame->exposure_start, last) << i;
    EXPECT_LE(frame->exposure_end, HostClock::now() + milliseconds(1)) << i;
    last = frame->exposure_start;
  }
}

TEST_F(AnAravisCamera, DeliversSixteenBitAndRegionsWithLargePackets) {
  serve();
  const auto camera = open(8000);
  for (const SensorFormat format : {SensorFormat::kMono16, SensorFormat::kMono12, SensorFormat::kMono8}) {
    CameraSettings wanted = settings();
    wanted.pixel_format = format;
    wanted.width = 100;
    wanted.height = 50;
    wanted.offset_x = 33;
    wanted.offset_y = 7;
    const CameraSettings effective = camera->configure(wanted);
    EXPECT_EQ(effective.width, 100);
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
    EXPECT_EQ(frame->image.width, 100);
    EXPECT_EQ(frame->image.format, wanted.slice_format());
    bool found = false;
    for (std::uint64_t exposure = 0; exposure < 10; ++exposure) found = found || shows(*frame, exposure, 33, 7);
    EXPECT_TRUE(found);
  }
}

TEST_F(AnAravisCamera, DeliversEveryPixelFormatAsSlices) {
  serve();
  const auto camera = open(8000);
  for (const SensorFormat format : kAllSensorFormats) {
    const SensorFormatInfo info = sensor_format_info(format);
    SCOPED_TRACE(info.name);
    CameraSettings wanted = settings();
    wanted.pixel_format = format;
    wanted.width = 101;
    wanted.height = 51;
    camera->configure(wanted);
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
    EXPECT_EQ(frame->image.format, wanted.slice_format());
    EXPECT_EQ(significant_bits(frame->image.format), info.bits);
    if (info.bayer) {
      // The scene grows by 3 a column: green sites show it as it is, others the mean of their neighbours.
      const bool wide = info.bits > 8;
      const auto pixel = [&](int x, int y) {
        return wide ? int{frame->image.as<std::uint16_t>().at(x, y)} : int{frame->image.as<std::uint8_t>().at(x, y)};
      };
      const bool green_first = info.name[5] == 'G';
      for (int x = 20; x < 24; ++x) {
        const int y = 10 + ((x % 2 == 0) == green_first ? 0 : 1);
        EXPECT_EQ(pixel(x + 2, y) - pixel(x, y), 6) << "green at " << x << ", " << y;
      }
      continue;
    }
    bool found = false;
    for (std::uint64_t exposure = 0; exposure < 60; ++exposure) found = found || shows(*frame, exposure);
    EXPECT_TRUE(found);
  }
}

TEST_F(AnAravisCamera, BringsUpperBitsDown) {
  serve();
  const auto camera = open(8000);
  CameraSettings wanted = settings();
  wanted.pixel_format = SensorFormat::kMono16;
  wanted.significant_bits = 12;
  camera->configure(wanted);
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
  EXPECT_EQ(frame->image.format, PixelFormat::kMono12);
  EXPECT_EQ(frame->image.as<std::uint16_t>().at(160, 100), CountingSource::expected(1, 160, 100) >> 4U);
  wanted.significant_bits = 11;
  FVD_EXPECT_ERROR(kCameraSettings, camera->configure(wanted));
  wanted = settings();
  wanted.pixel_format = SensorFormat::kBayerRG8;
  wanted.width = 100;
  wanted.height = 50;
  wanted.offset_x = 1;
  FVD_EXPECT_ERROR_SAYING(kCameraSettings, camera->configure(wanted), testing::HasSubstr("colours"));
}

TEST_F(AnAravisCamera, TakesBlockIdsOf64Bit) {
  server_ = std::make_unique<sim::GigeCameraServer>(
      source_, sim::GigeCameraOptions{.address = address_, .first_block_id = 0x1FFFFFFF0, .extended_ids = true});
  const auto camera = open();
  camera->configure(settings());
  server_->set_packet_loss(0.02);
  std::uint64_t last = 0;
  for (int i = 0; i < 30; ++i) {
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk) << i;
    EXPECT_TRUE(last == 0 || frame->id == last + 1) << frame->id << " after " << last;
    last = frame->id;
  }
  EXPECT_GT(last, 0x1FFFFFFF0U);
  EXPECT_GT(server_->packets_resent(), 0U);
}

TEST_F(AnAravisCamera, RunsFreeAtItsRateAndIsQuietAgain) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  CameraSettings free = settings();
  free.trigger = TriggerMode::kFreeRun;
  free.frame_rate_hz = 100.0;
  EXPECT_NEAR(camera->configure(free).frame_rate_hz, 100.0, 0.1);
  std::vector<HostTime> starts;
  while (starts.size() < 20) {
    const auto frame = camera->next_frame(HostClock::now() + std::chrono::seconds(2));
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
    starts.push_back(frame->exposure_start);
  }
  EXPECT_GT(std::chrono::duration<double>(starts.back() - starts.front()).count(), 0.17) << "no faster than its rate";
  camera->configure(settings());
  EXPECT_FALSE(camera->next_frame(HostClock::now() + milliseconds(60)).has_value());
  EXPECT_TRUE(shoot(*camera).has_value());
}

TEST_F(AnAravisCamera, KeepsCountingAcrossTheWrapOfBlockIds) {
  serve(65530);
  const auto camera = open();
  camera->configure(settings());
  std::uint64_t last = 0;
  for (int i = 0; i < 12; ++i) {
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk);
    EXPECT_TRUE(last == 0 || frame->id == last + 1) << frame->id << " after " << last;
    last = frame->id;
  }
}

TEST_F(AnAravisCamera, RecoversLostPacketsByResend) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  server_->set_packet_loss(0.05);
  for (int i = 0; i < 40; ++i) {
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk) << i;
  }
  EXPECT_GT(server_->packets_lost(), 10U);
  EXPECT_GT(server_->packets_resent(), 10U);
}

TEST_F(AnAravisCamera, ReportsNothingForAFrameThatNeverComesAndGoesOn) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  server_->faults().add({.fault = sim::CameraFault::kDropFrame});
  EXPECT_FALSE(shoot(*camera).has_value());
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->status, FrameStatus::kOk);
  server_->faults().add({.fault = sim::CameraFault::kIgnoreTrigger});
  EXPECT_FALSE(shoot(*camera).has_value());
  EXPECT_TRUE(shoot(*camera).has_value());
}

TEST_F(AnAravisCamera, GivesALateFrameItsOwnTime) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  server_->faults().add({.fault = sim::CameraFault::kLateFrame, .delay = milliseconds(400)});
  const HostTime triggered = HostClock::now();
  EXPECT_FALSE(shoot(*camera).has_value());
  const auto late = camera->next_frame(HostClock::now() + milliseconds(500));
  ASSERT_TRUE(late.has_value());
  EXPECT_LT(late->exposure_start, triggered + milliseconds(100));
}

TEST_F(AnAravisCamera, RefusesFramesOfAnotherSize) {
  serve();
  const auto camera = open();
  camera->configure(settings());
  server_->faults().add({.fault = sim::CameraFault::kWrongSize});
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_NE(frame->status, FrameStatus::kOk);
  const auto next = shoot(*camera);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->status, FrameStatus::kOk);
}

TEST(FrameCounter, GoesNotBelowZeroForALateFrameOfBeforeItsStart) {
  FrameCounter counter;
  EXPECT_EQ(counter.unwrap(10), 10U);
  EXPECT_EQ(counter.unwrap(60000), 0U) << "older than the first, or much newer: it is not believed";
  EXPECT_EQ(counter.unwrap(11), 11U);
}

TEST(FrameCounter, UnwrapsAcrossTheEndAndTellsLateFrames) {
  FrameCounter counter;
  EXPECT_EQ(counter.unwrap(65534), 65534U);
  EXPECT_EQ(counter.unwrap(65535), 65535U);
  EXPECT_EQ(counter.unwrap(1), 65536U);
  EXPECT_EQ(counter.unwrap(3), 65538U);
  EXPECT_EQ(counter.unwrap(2), 65537U) << "late";
  EXPECT_EQ(counter.unwrap(65535), 65535U) << "late from before the wrap";
  EXPECT_EQ(counter.unwrap(4), 65539U);
  counter.restart();
  EXPECT_GT(counter.unwrap(1), 65539U) << "a restart at the camera does not turn time back";
}

}  // namespace
}  // namespace fvd
