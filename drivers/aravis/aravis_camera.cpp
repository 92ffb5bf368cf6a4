#include "drivers/aravis/aravis_camera.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <arv.h>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/aravis/acquisition.hpp"
#include "drivers/aravis/camera_features.hpp"
#include "drivers/aravis/camera_presence.hpp"
#include "drivers/aravis/device_thread.hpp"
#include "drivers/aravis/gige_transport.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Poll interval of a wait for a frame: for interrupt(), and for the answer to a question.
constexpr microseconds kPollInterval{10000};
/// A command not acknowledged within this time: is the camera still there?
constexpr milliseconds kAcknowledgeTimeout{100};
/// A frame late by this time: is the camera still there?
constexpr milliseconds kFrameOverdue{20};

void check(const CameraSettings& settings) {
  const int bits = settings.significant_bits;
  if (bits != 0 && (settings.pixel_format != SensorFormat::kMono16 || (bits != 10 && bits != 12))) {
    throw Error(ErrorCode::kCameraSettings, "significant_bits is " + std::to_string(bits) +
                                                "; it is for Mono16 and must be 10 or 12, or 0 for all 16");
  }
  if (sensor_format_info(settings.pixel_format).bayer && (settings.offset_x % 2 != 0 || settings.offset_y % 2 != 0)) {
    throw Error(ErrorCode::kCameraSettings,
                "the region of a colour mosaic must begin at even offsets, or its colours change places");
  }
  if (settings.pool_frames >= 3 && settings.exposure_us > 0.0 && settings.width >= 0 && settings.height >= 0) return;
  throw Error(
      ErrorCode::kCameraSettings,
      "camera settings out of range: a pool of at least 3 frames, exposure_us above 0, and width and height not "
      "below 0 are needed");
}

/// What a command came to, without sharing an exception between two threads.
template <typename Value>
struct Answer {
  std::optional<Value> value;
  ErrorCode code = ErrorCode::kInternal;
  std::string message;
};

template <typename Command>
auto answering(Command run) {
  return [run = std::move(run)]() -> Answer<decltype(run())> {
    try {
      return {run(), {}, {}};
    } catch (const Error& error) {
      return {std::nullopt, error.code(), error.what()};
    }
  };
}

GObjectPtr<ArvCamera> open(const CameraConfig& config, CameraPresence& presence) {
  presence.require_free();
  GErrorSlot error;
  GObjectPtr<ArvCamera> camera(arv_camera_new(config.address.c_str(), error.out()));
  if (!camera) {
    throw Error(ErrorCode::kCameraDisconnected, "no camera at " + config.address + ": " + error.message() +
                                                    "; is it powered, in this network, and its address right?");
  }
  presence.watch(arv_camera_get_device(camera.get()));
  // Off by default: without it Aravis sends values the camera's own description forbids.
  arv_camera_set_range_check_policy(camera.get(), ARV_RANGE_CHECK_POLICY_ENABLE);
  return camera;
}

class AravisCamera final : public Camera {
 public:
  AravisCamera(const CameraConfig& config, milliseconds clock_renewal)
      : config_(config),
        presence_(config_.address),
        camera_(open(config_, presence_)),
        features_(camera_.get(), config_.address),
        acquisition_(camera_.get(), config_, features_, presence_, clock_renewal) {
    read_info();
    if (arv_camera_is_gv_device(camera_.get())) {
      set_packet_size(camera_.get(), features_, config_);
      warn_of_system_limits(config_.packet_socket);
    } else if (arv_camera_is_uv_device(camera_.get())) {
      arv_camera_uv_set_usb_mode(camera_.get(),
                                 config_.usb_mode == "async" ? ARV_UV_USB_MODE_ASYNC : ARV_UV_USB_MODE_SYNC);
    }
  }

  [[nodiscard]] CameraInfo info() const override { return info_; }

  CameraSettings configure(const CameraSettings& settings) override {
    check(settings);
    interrupted_ = false;  // that was for a wait of before
    CameraSettings in_force = command([this, settings] {
      acquisition_.configure(settings);
      return acquisition_.in_force();
    });
    quiet_since_ = HostClock::now();
    return in_force;
  }

  void trigger() override {
    presence_.require_connected();
    while (trigger_.valid() && !acknowledged()) presence_.require_life();
    quiet_since_ = HostClock::now();
    trigger_ = device_.post(answering([this] {
      acquisition_.send_trigger();
      return true;
    }));
    renew_clock_if_due();
    if (!acknowledged()) presence_.require_life();  // an acknowledge may get lost; the frame comes all the same
  }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    CameraPresence::Question question;
    for (;;) {
      const HostTime now = HostClock::now();
      const auto left = std::chrono::duration_cast<microseconds>(std::max(deadline, now) - now);
      const microseconds wait = question.open ? kPollInterval : std::min(left, kPollInterval);
      if (ArvBuffer* buffer = acquisition_.pop(wait)) {
        quiet_since_ = HostClock::now();
        auto frame = acquisition_.take(buffer);
        if (!frame) continue;
        if (frame->status == FrameStatus::kOk) renew_clock_if_due();
        return frame;
      }
      if (interrupted_.exchange(false)) return std::nullopt;
      presence_.require_connected();
      if (left > microseconds(0) || question.open) watch_over(question);
      if (HostClock::now() >= deadline && !question.open) return std::nullopt;
    }
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return acquisition_.frame_deadline(); }

  void interrupt() noexcept override { interrupted_ = true; }

  [[nodiscard]] bool connected() const noexcept override { return !presence_.lost(); }

  [[nodiscard]] CameraHealth health() const override { return acquisition_.health(); }

 private:
  void read_info() {
    const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
    GErrorSlot error;
    info_.vendor = text(arv_camera_get_vendor_name(camera_.get(), error.out()));
    info_.model = text(arv_camera_get_model_name(camera_.get(), error.out()));
    info_.serial = text(arv_camera_get_device_serial_number(camera_.get(), error.out()));
    info_.address = config_.address;
    features_.sensor_size(info_.sensor_width, info_.sensor_height);
    info_.simulated = config_.simulated || (info_.vendor == "fvd" && info_.model == "SimulatedCamera");
  }

  /// Asks a camera that is silent for longer than it should be whether it is alive.
  void watch_over(CameraPresence::Question& question) {
    const HostTime now = HostClock::now();
    if (!question.open && now < quiet_since_ + acquisition_.longest_frame_time() + kFrameOverdue) return;
    if (!presence_.answers(question)) return;
    quiet_since_ = now;
    acquisition_.resynchronise();
  }

  /// Runs it on the device's thread and waits for as long as the camera is alive. What the command refers to must not
  /// be of the caller's frame: it may outlast the wait.
  template <typename Command>
  auto command(Command run) -> decltype(run()) {
    presence_.require_connected();
    auto result = device_.post(answering(std::move(run)));
    while (result.wait_for(kAcknowledgeTimeout) != std::future_status::ready) presence_.require_life();
    auto answer = result.get();
    if (answer.value) return std::move(*answer.value);
    if (answer.code == ErrorCode::kCameraDisconnected) presence_.set_lost();
    throw Error(answer.code, answer.message);
  }

  /// True once the last trigger was answered.
  bool acknowledged() {
    if (trigger_.wait_for(kAcknowledgeTimeout) != std::future_status::ready) return false;
    const auto answer = trigger_.get();
    if (answer.value) return true;
    if (answer.code == ErrorCode::kCameraDisconnected) {
      presence_.set_lost();
      throw Error(answer.code, answer.message);
    }
    // There, but busy: no frame comes, and the caller's deadline tells.
    spdlog::warn("{}", answer.message);
    return true;
  }

  void renew_clock_if_due() {
    // First: until the renewal is done, the device's thread writes what clock_due() reads.
    if (renewal_.valid() && renewal_.wait_for(milliseconds(0)) != std::future_status::ready) return;
    if (!acquisition_.clock_due()) return;
    renewal_ = device_.post([this] { acquisition_.renew_clock(); });
  }

  const CameraConfig config_;
  CameraPresence presence_;  // before the camera: outlives it
  GObjectPtr<ArvCamera> camera_;
  CameraFeatures features_;
  CameraInfo info_;
  Acquisition acquisition_;
  HostTime quiet_since_{};  // last thing heard or asked of the camera
  std::atomic<bool> interrupted_{false};
  std::future<Answer<bool>> trigger_;
  std::future<void> renewal_;
  DeviceThread device_;  // last: it ends before what its commands use
};

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const CameraConfig& config, std::chrono::milliseconds clock_renewal) {
  return std::make_unique<AravisCamera>(config, clock_renewal);
}

}  // namespace fvd
