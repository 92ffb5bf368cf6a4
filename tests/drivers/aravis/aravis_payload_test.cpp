/// Frames that carry more than their image, or another image than the configured one.

#include <gmock/gmock.h>

#include "tests/drivers/aravis/aravis_camera_fixture.hpp"

namespace fvd {
namespace {

using sim::CameraFault;
using test::AnAravisCamera;
using testing::AllOf;
using testing::HasSubstr;

class APayload : public AnAravisCamera {
 protected:
  std::unique_ptr<Camera> open_with(const sim::CameraFaultStep& step, SensorFormat format = SensorFormat::kMono8,
                                    bool extended_ids = false) {
    sim::GigeCameraOptions options;
    options.payload_margin_bytes = 4000;
    options.extended_ids = extended_ids;
    serve(options);
    auto camera = open();
    CameraSettings wanted = settings();
    wanted.pixel_format = format;
    camera->configure(wanted);
    fault(step);
    return camera;
  }
};

TEST_F(APayload, IsTakenWithChunksBehindTheImage) {
  for (const int plain : {0, 1}) {
    const auto camera = open_with({.fault = CameraFault::kChunkMode, .after = 1, .value = plain});
    for (std::uint64_t i = 1; i <= 4; ++i) {
      const auto frame = shoot(*camera);
      ASSERT_TRUE(frame.has_value()) << i;
      ASSERT_EQ(frame->status, FrameStatus::kOk) << i << " " << camera->last_refusal();
      EXPECT_TRUE(shows(*frame, i));
    }
  }
}

TEST_F(APayload, IsTakenWithChunksThatTheCameraAnnounces) {
  serve();
  for (const int plain : {0, 1}) {
    const auto camera = open();
    fault({.fault = CameraFault::kChunkMode, .on = sim::CameraEvent::kCommand, .value = plain});
    camera->configure(settings());
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->status, FrameStatus::kOk) << camera->last_refusal();
  }
}

TEST_F(APayload, IsTakenWithPaddedLines) {
  for (const SensorFormat format : {SensorFormat::kMono8, SensorFormat::kMono12, SensorFormat::kMono12p}) {
    const auto camera = open_with({.fault = CameraFault::kPaddedLines, .count = 3, .value = 12}, format);
    for (std::uint64_t i = 1; i <= 4; ++i) {
      const auto frame = shoot(*camera);
      ASSERT_TRUE(frame.has_value()) << i;
      ASSERT_EQ(frame->status, FrameStatus::kOk) << i << " " << camera->last_refusal();
      EXPECT_TRUE(shows(*frame, i)) << i;
    }
  }
}

TEST_F(APayload, OfAnotherPixelFormatIsRefusedByThatName) {
  const auto camera = open_with({.fault = CameraFault::kOtherFormat});
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->status, FrameStatus::kWrongGeometry);
  EXPECT_THAT(camera->last_refusal(), AllOf(HasSubstr("BayerRG8"), HasSubstr("Mono8")));
  const auto next = shoot(*camera);
  ASSERT_TRUE(next && next->status == FrameStatus::kOk);
}

TEST_F(APayload, OfAnotherSizeIsRefusedByItsSize) {
  const auto camera = open_with({.fault = CameraFault::kWrongSize});
  const auto frame = shoot(*camera);
  ASSERT_TRUE(frame.has_value());
  EXPECT_NE(frame->status, FrameStatus::kOk);
  EXPECT_THAT(camera->last_refusal(), HasSubstr("320 x 100"));
}

TEST_F(APayload, WithAPacketThatIsUnavailableIsFollowedByAGoodOne) {
  for (const bool extended_ids : {false, true}) {
    const auto camera = open_with({.fault = CameraFault::kDropPacket, .value = 1}, SensorFormat::kMono8, extended_ids);
    const auto frame = shoot(*camera);
    EXPECT_TRUE(!frame || frame->status == FrameStatus::kIncomplete);
    const auto next = shoot(*camera);
    ASSERT_TRUE(next && next->status == FrameStatus::kOk);
    EXPECT_TRUE(shows(*next, 2));
  }
}

TEST_F(APayload, OfExtendedIdsComesThroughLoss) {
  const auto camera = open_with({.fault = CameraFault::kDropPacket, .count = 5}, SensorFormat::kMono8, true);
  std::uint64_t last_id = 0;
  for (std::uint64_t i = 1; i <= 10; ++i) {
    const auto frame = shoot(*camera);
    ASSERT_TRUE(frame && frame->status == FrameStatus::kOk) << i;
    EXPECT_TRUE(shows(*frame, i));
    EXPECT_GT(frame->id, last_id);
    last_id = frame->id;
  }
}

}  // namespace
}  // namespace fvd
