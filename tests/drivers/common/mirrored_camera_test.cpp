#include "drivers/common/mirrored_camera.hpp"

#include <cstring>

#include "gtest/gtest.h"
#include "sim/fakes/fakes.hpp"

namespace fvd {
namespace {

/// A sensor of 4 x 2 pixels that show 0 to 7, and remembers what it was configured with.
class CountingCamera final : public sim::FakeCamera {
 public:
  explicit CountingCamera(sim::FakeClock& clock) : FakeCamera(clock, 4, 2) {
    paint = [](int, std::span<std::byte> pixels) {
      for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::byte>(i);
    };
  }
  [[nodiscard]] CameraInfo info() const override {
    CameraInfo info = FakeCamera::info();
    info.sensor_width = 1000;
    info.sensor_height = 600;
    return info;
  }
  CameraSettings configure(const CameraSettings& settings) override {
    configured = settings;
    if (configured.width == 0) configured.width = 1000 - configured.offset_x;
    if (configured.height == 0) configured.height = 600 - configured.offset_y;
    return configured;
  }
  CameraSettings configured;
};

std::string pixels_with(const Mirror& mirror) {
  sim::FakeClock clock;
  const auto camera = upright(std::make_unique<CountingCamera>(clock), mirror);
  camera->trigger();
  const auto frame = camera->next_frame(clock.now() + std::chrono::seconds(1));
  std::string text;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) text += static_cast<char>('0' + frame->image.as<std::uint8_t>().at(x, y));
  }
  return text;
}

TEST(AMirroredCamera, DeliversUprightFrames) {
  EXPECT_EQ(pixels_with({}), "01234567");
  EXPECT_EQ(pixels_with({true, false}), "32107654");
  EXPECT_EQ(pixels_with({false, true}), "45670123");
  EXPECT_EQ(pixels_with({true, true}), "76543210");
}

TEST(AMirroredCamera, LeavesADamagedFrameAlone) {
  sim::FakeClock clock;
  const auto camera = upright(
      std::make_unique<sim::FakeCamera>(clock, 4, 2, std::deque<sim::TriggerOutcome>{sim::TriggerOutcome::kIncomplete}),
      {true, true});
  camera->trigger();
  const auto frame = camera->next_frame(clock.now() + std::chrono::seconds(1));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->status, FrameStatus::kIncomplete);
}

TEST(AMirroredCamera, CountsRegionsFromTheUprightPicturesCorner) {
  sim::FakeClock clock;
  auto owned = std::make_unique<CountingCamera>(clock);
  const CountingCamera& sensor = *owned;
  const auto camera = upright(std::move(owned), {true, false});
  CameraSettings region;
  region.width = 300;
  region.height = 200;
  region.offset_x = 100;
  region.offset_y = 50;
  const CameraSettings in_force = camera->configure(region);
  EXPECT_EQ(sensor.configured.offset_x, 600) << "what is left in the picture lies on the right of the sensor";
  EXPECT_EQ(sensor.configured.offset_y, 50);
  EXPECT_EQ(in_force, region);

  region.width = 0;  // the rest, from the offset on
  const CameraSettings rest = camera->configure(region);
  EXPECT_EQ(sensor.configured.offset_x, 0);
  EXPECT_EQ(sensor.configured.width, 900);
  EXPECT_EQ(rest.offset_x, 100);
  EXPECT_EQ(rest.width, 900);
}

TEST(AMirroredCamera, OfAWholeSensorIsTheWholeSensor) {
  sim::FakeClock clock;
  const auto camera = upright(std::make_unique<CountingCamera>(clock), {true, true});
  const CameraSettings in_force = camera->configure({});
  EXPECT_EQ(in_force.offset_x, 0);
  EXPECT_EQ(in_force.offset_y, 0);
  EXPECT_EQ(in_force.width, 1000);
  EXPECT_EQ(in_force.height, 600);
}

}  // namespace
}  // namespace fvd
