#include "drivers/aravis/aravis_camera.hpp"

#include <algorithm>
#include <array>
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
#include "drivers/aravis/busy_commands.hpp"
#include "drivers/aravis/camera_features.hpp"
#include "drivers/aravis/camera_presence.hpp"
#include "drivers/aravis/camera_search.hpp"
#include "drivers/aravis/device_thread.hpp"
#include "drivers/aravis/gige_transport.hpp"
#include "drivers/aravis/gobject.hpp"
#include "drivers/gige/gvcp_socket.hpp"

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

/// The name by which Aravis opens the USB3 Vision camera with this serial number; empty if Aravis does not see it.
std::string usb_id_of(const std::string& serial) {
  arv_disable_interface("GigEVision");  // or it broadcasts, and waits for answers
  arv_update_device_list();
  std::string id;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    const char* theirs = arv_get_device_serial_nbr(i);
    if (theirs != nullptr && serial == theirs) id = arv_get_device_id(i);
  }
  arv_enable_interface("GigEVision");
  return id;
}

[[noreturn]] void throw_damaged(const std::string& name, const std::string& why, const LogCollector& parser) {
  const std::string detail = parser.first().empty() ? "" : " (" + parser.first() + ")";
  throw Error(ErrorCode::kCameraDisconnected, "the description (GenICam XML) in the camera " + name +
                                                  " is damaged: " + why + detail +
                                                  "; power the camera off and on, else renew its firmware");
}

GObjectPtr<ArvCamera> open(const CameraTarget& target, CameraPresence& presence) {
  repeat_busy_commands();
  const bool network = gvcp::address_of(target.open_by).has_value();
  if (network) presence.require_free(target.open_by);
  const std::string name = network ? target.open_by : usb_id_of(target.open_by);
  const LogCollector parser("XML");
  GErrorSlot error;
  GObjectPtr<ArvCamera> camera;
  (void)while_busy([&] {
    if (!name.empty()) camera.reset(arv_camera_new(name.c_str(), error.out()));
    return !camera && error.is_busy();
  });
  if (error.is_bad_description()) throw_damaged(target.name, error.message(), parser);
  if (!camera) {
    const std::string hint = target.identity ? "; it tells who it is and refuses what opening needs: power it off and "
                                               "on, and see whether a firewall or another program is in the way"
                                             : "";
    throw Error(ErrorCode::kCameraDisconnected,
                "the camera " + target.name +
                    " cannot be opened: " + (name.empty() ? "Aravis does not list it" : error.message()) + hint);
  }
  presence.watch(arv_camera_get_device(camera.get()));
  for (const char* feature : {"Width", "Height", "PixelFormat", "PayloadSize", "AcquisitionStart", "AcquisitionStop"}) {
    if (arv_device_get_feature(arv_camera_get_device(camera.get()), feature) != nullptr) continue;
    throw_damaged(target.name, std::string("it has no ") + feature, parser);
  }
  // Off by default: without it Aravis sends values the camera's own description forbids.
  arv_camera_set_range_check_policy(camera.get(), ARV_RANGE_CHECK_POLICY_ENABLE);
  return camera;
}

/// The serial number of the GigE Vision camera that is under control: two of one address answer a search in turns.
std::string controlled_serial(ArvDevice* device) {
  constexpr guint64 kSerialRegister = 0x00D8;
  std::array<char, 17> text{};  // sixteen, and an end
  GErrorSlot error;
  arv_device_read_memory(device, kSerialRegister, text.size() - 1, text.data(), error.out());
  error.check("the camera does not tell its serial number", ErrorCode::kCameraDisconnected);
  return text.data();
}

void require_same(const CameraTarget& found, const std::string& opened) {
  if (opened == found.identity->serial) return;
  throw Error(ErrorCode::kCameraDisconnected, "another camera, of serial number " + opened + ", was opened at " +
                                                  found.open_by + " than " + found.identity->text() +
                                                  ", which was found there: do two have this address?");
}

/// The configuration with the name that messages use in the address' place.
CameraConfig called(CameraConfig config, const std::string& name) {
  config.address = name;
  return config;
}

class AravisCamera final : public Camera {
 public:
  AravisCamera(const CameraConfig& config, const CameraTarget& target, milliseconds clock_renewal)
      : config_(called(config, target.name)),
        presence_(target.name, milliseconds(config.silence_ms)),
        camera_(open(target, presence_)),
        features_(camera_.get(), config_.address),
        acquisition_(camera_.get(), config_, features_, presence_, clock_renewal) {
    read_info(target);
    if (target.identity) require_same(target, info_.serial);
    require_serial(config, info_.serial, camera_text(info_));
    spdlog::info("camera: {}", camera_text(info_));
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
    presence_.heard();
    CameraSettings in_force = command([this, settings] {
      acquisition_.configure(settings);
      return acquisition_.in_force();
    });
    hear();
    return in_force;
  }

  void trigger() override {
    presence_.require_connected();
    while (trigger_.valid() && !acknowledged(kPollInterval)) {
      if (interrupted_) return;
      if (HostClock::now() > triggered_ + kAcknowledgeTimeout) (void)presence_.alive();
    }
    triggered_ = quiet_since_ = HostClock::now();
    trigger_ = device_.post(answering([this] {
      acquisition_.send_trigger();
      return true;
    }));
    renew_clock_if_due();
    // An acknowledge may get lost; the frame comes all the same.
    if (!acknowledged(kAcknowledgeTimeout)) (void)presence_.alive();
  }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    for (;;) {
      const HostTime now = HostClock::now();
      const auto left = std::chrono::duration_cast<microseconds>(std::max(deadline, now) - now);
      if (ArvBuffer* buffer = acquisition_.pop(std::min(left, kPollInterval))) {
        hear();
        auto frame = acquisition_.take(buffer);
        if (seems_too_old(frame)) acquisition_.doubt_clock();
        renew_clock_if_due();
        if (!frame) continue;
        if (frame->status == FrameStatus::kMisdated) await_clock();  // or the next frame would be refused as well
        return frame;
      }
      if (interrupted_.exchange(false)) return std::nullopt;
      presence_.require_connected();
      if (left > microseconds(0) || presence_.asking()) watch_over();
      if (HostClock::now() >= deadline) return std::nullopt;
    }
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override { return acquisition_.frame_deadline(); }

  void interrupt() noexcept override { interrupted_ = true; }

  [[nodiscard]] std::string last_refusal() const override { return acquisition_.refusal(); }

  void look_after() override {
    try {
      presence_.look_after();
      if (connected()) renew_clock_early();
    } catch (const Error& error) {
      spdlog::warn("{}", error.what());
    }
  }

  [[nodiscard]] bool connected() const noexcept override { return !presence_.lost(); }

  [[nodiscard]] CameraHealth health() const override { return acquisition_.health(); }

 private:
  /// What a GigE Vision camera tells everybody is not asked again.
  void read_info(const CameraTarget& target) {
    const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
    GErrorSlot error;
    const FoundCamera& known = target.identity.value_or(FoundCamera{});
    info_.vendor = target.identity ? known.vendor : text(arv_camera_get_vendor_name(camera_.get(), error.out()));
    info_.model = target.identity ? known.model : text(arv_camera_get_model_name(camera_.get(), error.out()));
    info_.serial = arv_camera_is_gv_device(camera_.get())
                       ? controlled_serial(arv_camera_get_device(camera_.get()))
                       : text(arv_camera_get_device_serial_number(camera_.get(), error.out()));
    info_.firmware = known.firmware;
    for (const char* feature : {"DeviceFirmwareVersion", "DeviceVersion"}) {
      if (!info_.firmware.empty() || !features_.available(feature)) continue;
      info_.firmware = text(arv_camera_get_string(camera_.get(), feature, error.out()));
    }
    info_.address = target.open_by;
    features_.sensor_size(info_.sensor_width, info_.sensor_height);
    info_.sensor_width = features_.on_grid("Width", info_.sensor_width);
    info_.sensor_height = features_.on_grid("Height", info_.sensor_height);
    info_.simulated = config_.simulated || (info_.vendor == "fvd" && info_.model == "SimulatedCamera");
  }

  /// Asks a camera that is silent for longer than it should be whether it is alive.
  void watch_over() {
    const HostTime now = HostClock::now();
    if (!presence_.asking() && now < quiet_since_ + acquisition_.longest_frame_time() + kFrameOverdue) return;
    if (!presence_.alive()) return;
    quiet_since_ = now;
    acquisition_.resynchronise();
  }

  void hear() {
    quiet_since_ = HostClock::now();
    presence_.heard();
  }

  /// Exposed before it was triggered, or longer ago than a frame takes: late, a repetition, or the clock was set back.
  [[nodiscard]] bool seems_too_old(const std::optional<Frame>& frame) const {
    if (!frame) return true;
    if (frame->status != FrameStatus::kOk) return false;
    return acquisition_.in_force().trigger == TriggerMode::kSoftware
               ? frame->exposure_end < triggered_
               : frame->exposure_end < HostClock::now() - acquisition_.frame_deadline();
  }

  /// Runs it on the device's thread and waits for as long as the camera is alive. What the command refers to must not
  /// be of the caller's frame: it may outlast the wait.
  template <typename Command>
  auto command(Command run) -> decltype(run()) {
    presence_.require_connected();
    auto result = device_.post(answering(std::move(run)));
    const HostTime begun = HostClock::now();
    while (result.wait_for(kPollInterval) != std::future_status::ready) {
      if (interrupted_)
        throw Error(ErrorCode::kAborted, "stopped while the camera at " + config_.address + " was set up");
      if (HostClock::now() > begun + kAcknowledgeTimeout) (void)presence_.alive();
    }
    auto answer = result.get();
    if (answer.value) return std::move(*answer.value);
    if (answer.code == ErrorCode::kCameraDisconnected) presence_.set_lost();
    throw Error(answer.code, answer.message);
  }

  /// True once the last trigger was answered.
  bool acknowledged(microseconds within) {
    if (trigger_.wait_for(within) != std::future_status::ready) return false;
    const auto answer = trigger_.get();
    if (answer.value) {
      presence_.heard();
      return true;
    }
    if (answer.code == ErrorCode::kCameraDisconnected) {
      presence_.set_lost();
      throw Error(answer.code, answer.message);
    }
    // There, but busy: no frame comes, and the caller's deadline tells.
    spdlog::warn("{}", answer.message);
    return true;
  }

  /// Waits until the clock was measured since it became doubtful.
  void await_clock() {
    const HostTime begun = HostClock::now();
    for (int i = 0; i < 2; ++i) {  // one renewal may have been on its way before
      while (renewal_.valid() && renewal_.wait_for(kPollInterval) != std::future_status::ready) {
        if (interrupted_) return;
        if (HostClock::now() > begun + kAcknowledgeTimeout) (void)presence_.alive();
      }
      renew_clock_if_due();
    }
  }

  /// Nothing that needs time is asked now; the next scan need not do it while its first motion waits.
  void renew_clock_early() {
    if (is_renewing() || !acquisition_.clock_due_soon()) return;
    renewal_ = device_.post([this] { acquisition_.renew_clock_early(); });
  }

  void renew_clock_if_due() {
    if (is_renewing() || !acquisition_.clock_due()) return;
    renewal_ = device_.post([this] { acquisition_.renew_clock(); });
  }

  /// One at a time: until it is done the clock is due as before.
  [[nodiscard]] bool is_renewing() const {
    return renewal_.valid() && renewal_.wait_for(milliseconds(0)) != std::future_status::ready;
  }

  const CameraConfig config_;
  CameraPresence presence_;  // before the camera: outlives it
  GObjectPtr<ArvCamera> camera_;
  CameraFeatures features_;
  CameraInfo info_;
  Acquisition acquisition_;
  HostTime quiet_since_{};  // last thing heard or asked of the camera
  HostTime triggered_{};
  std::atomic<bool> interrupted_{false};
  std::future<Answer<bool>> trigger_;
  std::future<void> renewal_;
  DeviceThread device_;  // last: it ends before what its commands use
};

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const CameraConfig& config, std::chrono::milliseconds clock_renewal) {
  return open_aravis_camera(config, find_camera(config), clock_renewal);
}

std::unique_ptr<Camera> open_aravis_camera(const CameraConfig& config, const CameraTarget& found,
                                           std::chrono::milliseconds clock_renewal) {
  return std::make_unique<AravisCamera>(config, found, clock_renewal);
}

}  // namespace fvd
