#include "core/scan/autofocus.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/focus/grey_statistics.hpp"
#include "sim/fakes/fakes.hpp"
#include "tests/support/expect_error.hpp"

namespace fvd {
namespace {

/// A camera above a textured plane at `plane_um`: the contrast falls off as a Gaussian of defocus.
class TexturedCamera final : public Camera, private FrameRecycler {
 public:
  TexturedCamera(sim::FakeClock& clock, sim::FakeAxis& stage, double plane_um)
      : clock_(clock), stage_(stage), plane_um_(plane_um), pixels_(64 * 64) {}
  [[nodiscard]] CameraInfo info() const override { return {}; }
  CameraSettings configure(const CameraSettings& settings) override { return settings; }
  void trigger() override { triggered_ = true; }
  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    if (!triggered_) {
      clock_.advance_to(deadline);
      return std::nullopt;
    }
    triggered_ = false;
    const double defocus_um = stage_.status().position.value - plane_um_;
    const double contrast = 40.0 * std::exp(-defocus_um * defocus_um / (2 * 15.0 * 15.0));
    std::mt19937 random(5);
    std::normal_distribution<double> texture(0.0, 1.0);
    for (auto& pixel : pixels_) {
      pixel = static_cast<std::uint8_t>(std::clamp(128.0 + contrast * texture(random), 0.0, 255.0));
    }
    Frame frame;
    frame.status = FrameStatus::kOk;
    frame.id = ++id_;
    frame.exposure_start = frame.exposure_end = clock_.now();
    frame.image = {PixelFormat::kMono8, 64, 64, 64, reinterpret_cast<const std::byte*>(pixels_.data())};
    frame.lease = FrameLease(pixels_.data(), FrameSlotDeleter{this});
    return frame;
  }
  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return std::chrono::milliseconds(100); }
  void interrupt() noexcept override {}
  [[nodiscard]] bool connected() const noexcept override { return true; }
  [[nodiscard]] CameraHealth health() const override { return {}; }

 private:
  void recycle(void* /*slot*/) noexcept override {}
  sim::FakeClock& clock_;
  sim::FakeAxis& stage_;
  double plane_um_;
  std::vector<std::uint8_t> pixels_;
  std::uint64_t id_ = 0;
  bool triggered_ = false;
};

AutofocusPlan from_to(double from_um, double to_um) {
  AutofocusPlan plan;
  plan.from = Micrometers{from_um};
  plan.to = Micrometers{to_um};
  plan.step = Micrometers{10.0};
  return plan;
}

TEST(Autofocus, StopsWhereTheRegionIsSharpestAndComesFromBelow) {
  for (const double plane_um : {-31.3, 0.0, 47.8}) {
    sim::FakeClock clock;
    sim::FakeAxis stage(clock);
    TexturedCamera camera(clock, stage, plane_um);
    const AutofocusResult result = autofocus(camera, stage, clock, from_to(-100.0, 100.0), {});
    EXPECT_NEAR(result.z_um, plane_um, 0.5);
    ASSERT_GE(stage.targets_um.size(), 2U);
    EXPECT_EQ(stage.targets_um.back(), result.z_um);
    EXPECT_LE(stage.targets_um[stage.targets_um.size() - 2], result.z_um);
    EXPECT_TRUE(
        std::is_sorted(result.curve.begin(), result.curve.end(), [](auto& a, auto& b) { return a.z_um < b.z_um; }));
  }
}

TEST(Autofocus, StaysInItsRangeWhereTheStageStandsBesideItsTargets) {
  for (const double error_um : {-0.4, 0.4}) {
    sim::FakeClock clock;
    sim::FakeAxis stage(clock);
    stage.error_um = error_um;
    TexturedCamera camera(clock, stage, error_um < 0.0 ? -90.0 : 90.0);
    (void)autofocus(camera, stage, clock, from_to(-100.0, 100.0), {});
    const auto [lowest, highest] = std::minmax_element(stage.targets_um.begin(), stage.targets_um.end());
    EXPECT_GE(*lowest, -100.0 - stage.description.take_up.value);
    EXPECT_LE(*highest, 100.0);
  }
}

TEST(Autofocus, MovesNothingForARangeThatCannotBeSearched) {
  sim::FakeClock clock;
  sim::FakeAxis stage(clock);  // -500 to 500 um, 20 of take-up
  TexturedCamera camera(clock, stage, 0.0);
  const auto refused = [&](const AutofocusPlan& plan, ErrorCode code, const char* why) {
    test::expect_error(code, {why}, [&] { (void)autofocus(camera, stage, clock, plan, {}); });
  };
  refused(from_to(0.0, 2000.0), ErrorCode::kStageLimit, "nothing was moved");
  refused(from_to(-490.0, 100.0), ErrorCode::kStageLimit, "take-up");
  refused(from_to(100.0, 0.0), ErrorCode::kBadInput, "below");
  AutofocusPlan fine = from_to(0.0, 300.0);
  fine.step = Micrometers{0.001};
  refused(fine, ErrorCode::kBadInput, "more than 1000 steps");
  EXPECT_TRUE(stage.targets_um.empty());
}

TEST(Autofocus, SaysWhereNothingIsSharp) {
  sim::FakeClock clock;
  sim::FakeAxis stage(clock);
  TexturedCamera above(clock, stage, 300.0);
  test::expect_error(ErrorCode::kFocusRange, {"widen the range"},
                     [&] { (void)autofocus(above, stage, clock, from_to(-100.0, 100.0), {}); });
  test::expect_error(ErrorCode::kBadInput, {"3 of its steps"},
                     [&] { (void)autofocus(above, stage, clock, from_to(0.0, 20.0), {}); });
  stage.is_homed = false;
  test::expect_error(ErrorCode::kStageNotHomed, {"stage.home"},
                     [&] { (void)autofocus(above, stage, clock, from_to(-100.0, 100.0), {}); });
}

TEST(GreyStatistics, TellsLevelsAndWhatExposureWouldBeRight) {
  std::vector<std::uint8_t> pixels(1000, 50);
  for (std::size_t i = 0; i < 20; ++i) pixels[i] = 100;
  const ImageView image{PixelFormat::kMono8, 100, 10, 100, reinterpret_cast<const std::byte*>(pixels.data())};
  GreyStatistics grey = grey_statistics(image);
  EXPECT_EQ(grey.min, 50);
  EXPECT_EQ(grey.max, 100);
  EXPECT_EQ(grey.p50, 50);
  EXPECT_EQ(grey.p999, 100);
  EXPECT_DOUBLE_EQ(grey.mean, 51.0);
  EXPECT_EQ(grey.saturated_fraction, 0.0);
  EXPECT_NEAR(exposure_factor(grey, PixelFormat::kMono8, 0.8), 2.04, 1e-9);
  for (std::size_t i = 0; i < 20; ++i) pixels[i] = 255;
  grey = grey_statistics(image);
  EXPECT_DOUBLE_EQ(grey.saturated_fraction, 0.02);
  EXPECT_EQ(exposure_factor(grey, PixelFormat::kMono8, 0.8), 0.25) << "how bright it is cannot be seen";
  std::fill(pixels.begin(), pixels.end(), std::uint8_t{0});
  EXPECT_EQ(exposure_factor(grey_statistics(image), PixelFormat::kMono8, 0.8), 8.0);
}

}  // namespace
}  // namespace fvd
