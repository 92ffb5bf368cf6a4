#include "drivers/common/mirrored_camera.hpp"

#include <cstdint>
#include <utility>

namespace fvd {

namespace {

/// Where a region begins when it is counted from the other side. A length of 0 is the rest of the sensor from the
/// offset on, which counted from the other side begins at 0 and has a length.
void turn(int sensor, int& offset, int& length) {
  const int whole = length == 0 ? sensor - offset : length;
  if (length == 0 && offset == 0) return;
  offset = sensor - offset - whole;
  length = whole;
}

/// The frame has the sole right to its slot, which is memory of the driver and not constant.
template <typename Pixel>
PlaneView<Pixel> slot_of(const Frame& frame) {
  const PlaneView<const Pixel> image = frame.image.as<Pixel>();
  return {const_cast<Pixel*>(image.data), image.width, image.height, image.row_stride};
}

class MirroredCamera final : public Camera {
 public:
  MirroredCamera(std::unique_ptr<Camera> camera, const Mirror& mirror) : camera_(std::move(camera)), mirror_(mirror) {}

  [[nodiscard]] CameraInfo info() const override { return camera_->info(); }

  CameraSettings configure(const CameraSettings& settings) override {
    return turned(camera_->configure(turned(settings)));
  }

  void trigger() override { camera_->trigger(); }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    std::optional<Frame> frame = camera_->next_frame(deadline);
    if (!frame || frame->status != FrameStatus::kOk) return frame;
    if (bytes_per_pixel(frame->image.format) == 1) {
      mirror_in_place(slot_of<std::uint8_t>(*frame), mirror_);
    } else {
      mirror_in_place(slot_of<std::uint16_t>(*frame), mirror_);
    }
    return frame;
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return camera_->frame_deadline(); }
  void interrupt() noexcept override { camera_->interrupt(); }
  [[nodiscard]] std::string last_refusal() const override { return camera_->last_refusal(); }
  void look_after() override { camera_->look_after(); }
  [[nodiscard]] bool connected() const noexcept override { return camera_->connected(); }
  [[nodiscard]] CameraHealth health() const override { return camera_->health(); }

 private:
  [[nodiscard]] CameraSettings turned(CameraSettings settings) const {
    const CameraInfo sensor = camera_->info();
    if (mirror_.x) turn(sensor.sensor_width, settings.offset_x, settings.width);
    if (mirror_.y) turn(sensor.sensor_height, settings.offset_y, settings.height);
    return settings;
  }

  const std::unique_ptr<Camera> camera_;
  const Mirror mirror_;
};

}  // namespace

std::unique_ptr<Camera> upright(std::unique_ptr<Camera> camera, const Mirror& mirror) {
  if (!mirror.any()) return camera;
  return std::make_unique<MirroredCamera>(std::move(camera), mirror);
}

}  // namespace fvd
