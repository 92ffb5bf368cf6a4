#include "drivers/aravis/aravis_camera.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include <arv.h>
#include <spdlog/spdlog.h>

#include "core/error.hpp"
#include "drivers/aravis/camera_clock.hpp"
#include "drivers/aravis/control_watch.hpp"
#include "drivers/aravis/frame_buffers.hpp"
#include "drivers/aravis/frame_counter.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

using std::chrono::microseconds;

/// A wait for a frame looks up so often whether it was interrupted.
constexpr microseconds kWaitSlice{20000};

class AravisCamera final : public Camera {
 public:
  explicit AravisCamera(const CameraConfig& config) : config_(config) {
    GErrorSlot error;
    camera_.reset(arv_camera_new(config.address.c_str(), error.out()));
    if (!camera_) {
      throw Error(ErrorCode::kCameraDisconnected, "no camera at " + config.address + ": " + error.message() +
                                                      "; is it powered, in this network, and its address right?");
    }
    control_.watch(arv_camera_get_device(camera_.get()));
    require_control();
    // Off by default: without it Aravis sends values the camera's own description forbids.
    arv_camera_set_range_check_policy(camera_.get(), ARV_RANGE_CHECK_POLICY_ENABLE);
    read_info();
    if (arv_camera_is_gv_device(camera_.get())) configure_transport();
  }

  ~AravisCamera() override {
    stop_acquisition();
    frames_.reset();
  }

  [[nodiscard]] CameraInfo info() const override { return info_; }

  CameraSettings configure(const CameraSettings& settings) override {
    require_connected();
    if (!requested_ || *requested_ != settings || !frames_) {
      requested_.reset();
      stop_acquisition();
      frames_.reset();
      effective_ = apply(settings);
      start_acquisition();
      requested_ = settings;
    }
    clock_.measure(control_.device());
    if (!clock_.measured()) {
      throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address +
                                                  " has no usable timestamp latch: a late frame could not be told from "
                                                  "a fresh one, and heights would be wrong");
    }
    return effective_;
  }

  void trigger() override {
    require_connected();
    GErrorSlot error;
    arv_camera_software_trigger(camera_.get(), error.out());
    if (error.is_connection_loss()) control_.set_lost();
    error.check("the camera at " + config_.address + " takes no trigger", ErrorCode::kCameraDisconnected);
  }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    for (;;) {
      const auto left =
          std::chrono::duration_cast<microseconds>(std::max(deadline, HostClock::now()) - HostClock::now());
      ArvBuffer* buffer = frames_ ? frames_->pop(std::min(left, kWaitSlice)) : nullptr;
      if (buffer != nullptr) return examine(buffer);
      if (interrupted_.exchange(false)) return std::nullopt;
      require_connected();
      if (HostClock::now() >= deadline) return std::nullopt;
    }
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override {
    // Exposure, then the line: a gigabit a second, counted generously.
    const double payload =
        static_cast<double>(effective_.width) * effective_.height * bytes_per_pixel(effective_.slice_format());
    return microseconds(static_cast<std::int64_t>(effective_.exposure_us + payload * 0.02)) +
           std::chrono::milliseconds(config_.frame_margin_ms);
  }

  void interrupt() noexcept override { interrupted_ = true; }

  [[nodiscard]] bool connected() const noexcept override { return !control_.lost(); }

  [[nodiscard]] CameraHealth health() const override {
    CameraHealth health;
    health.frames_complete = frames_complete_;
    health.frames_failed = frames_failed_;
    if (!frames_) return health;
    guint64 completed = 0;
    guint64 failures = 0;
    guint64 underruns = 0;
    arv_stream_get_statistics(frames_->stream(), &completed, &failures, &underruns);
    health.underruns = underruns;
    if (ARV_IS_GV_STREAM(frames_->stream())) {
      guint64 resent = 0;
      guint64 missing = 0;
      arv_gv_stream_get_statistics(ARV_GV_STREAM(frames_->stream()), &resent, &missing);
      health.packets_resent = resent;
      health.packets_missing = missing;
    }
    return health;
  }

 private:
  void require_connected() const {
    if (control_.lost()) {
      throw Error(ErrorCode::kCameraDisconnected,
                  "the connection to the camera at " + config_.address + " is lost; it is being opened again");
    }
  }

  void require_control() const {
    if (!arv_camera_is_gv_device(camera_.get()) ||
        arv_gv_device_is_controller(ARV_GV_DEVICE(control_.device())) != FALSE)
      return;
    throw Error(ErrorCode::kCameraDisconnected,
                "the camera at " + config_.address +
                    " is controlled by another program, or by one that died less than its heartbeat timeout ago");
  }

  void read_info() {
    const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
    GErrorSlot error;
    info_.vendor = text(arv_camera_get_vendor_name(camera_.get(), error.out()));
    info_.model = text(arv_camera_get_model_name(camera_.get(), error.out()));
    info_.serial = text(arv_camera_get_device_serial_number(camera_.get(), error.out()));
    info_.address = config_.address;
    arv_camera_get_sensor_size(camera_.get(), &info_.sensor_width, &info_.sensor_height, error.out());
    error.check("the camera at " + config_.address + " does not tell its sensor's size");
    info_.simulated = config_.simulated || (info_.vendor == "fvd" && info_.model == "SimulatedCamera");
  }

  void configure_transport() {
    arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
    arv_camera_gv_set_stream_options(
        camera_.get(), config_.packet_socket ? ARV_GV_STREAM_OPTION_NONE : ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    GErrorSlot error;
    arv_camera_gv_set_packet_size(camera_.get(), config_.packet_size_bytes, error.out());
    error.check("the camera at " + config_.address + " refuses packets of " +
                std::to_string(config_.packet_size_bytes) + " bytes");
  }

  // --- settings ---

  void set_integer(const char* feature, gint64 value) {
    GErrorSlot error;
    arv_camera_set_integer(camera_.get(), feature, value, error.out());
    if (error.failed()) refuse(error, feature, std::to_string(value));
    const gint64 got = arv_camera_get_integer(camera_.get(), feature, error.out());
    error.check(std::string("reading ") + feature);
    if (got != value) mismatch(feature, std::to_string(value), std::to_string(got));
  }

  void set_number(const char* feature, double value) {
    GErrorSlot error;
    arv_camera_set_float(camera_.get(), feature, value, error.out());
    if (error.failed()) refuse(error, feature, std::to_string(value));
  }

  [[noreturn]] void refuse(const GErrorSlot& error, const std::string& feature, const std::string& value) const {
    error.check("the camera at " + config_.address + " refuses " + feature + " = " + value + range_of(feature));
    throw Error(ErrorCode::kInternal, "refuse() was called without an error");
  }

  [[noreturn]] void mismatch(const std::string& feature, const std::string& asked, const std::string& got) const {
    throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address + " was asked for " + feature + " = " +
                                                asked + " and reads back " + got + range_of(feature));
  }

  /// " (accepted: min..max)" where the camera's description tells.
  [[nodiscard]] std::string range_of(const std::string& feature) const {
    GErrorSlot error;
    std::ostringstream text;
    gint64 low = 0;
    gint64 high = 0;
    arv_camera_get_integer_bounds(camera_.get(), feature.c_str(), &low, &high, error.out());
    if (!error.failed()) {
      text << " (accepted: " << low << ".." << high << ")";
      return text.str();
    }
    double min = 0.0;
    double max = 0.0;
    arv_camera_get_float_bounds(camera_.get(), feature.c_str(), &min, &max, error.out());
    if (!error.failed()) text << " (accepted: " << min << ".." << max << ")";
    return text.str();
  }

  /// Format, region, exposure, gain, and the trigger last: setting any of the others may switch the trigger off.
  CameraSettings apply(const CameraSettings& settings) {
    CameraSettings effective = settings;
    if (effective.width == 0) effective.width = info_.sensor_width - settings.offset_x;
    if (effective.height == 0) effective.height = info_.sensor_height - settings.offset_y;
    GErrorSlot error;
    const std::string name(sensor_format_info(settings.pixel_format).name);
    arv_camera_set_pixel_format_from_string(camera_.get(), name.c_str(), error.out());
    if (error.failed()) refuse(error, "PixelFormat", name);
    set_integer("OffsetX", 0);
    set_integer("OffsetY", 0);
    set_integer("Width", effective.width);
    set_integer("Height", effective.height);
    set_integer("OffsetX", effective.offset_x);
    set_integer("OffsetY", effective.offset_y);
    apply_exposure(effective);
    arv_camera_set_trigger(camera_.get(), "Software", error.out());
    error.check("the camera at " + config_.address + " takes no software trigger");
    return effective;
  }

  void apply_exposure(CameraSettings& effective) {
    GErrorSlot error;
    set_number("ExposureTime", effective.exposure_us);
    const double exposure = arv_camera_get_float(camera_.get(), "ExposureTime", error.out());
    error.check("reading ExposureTime");
    // Cameras round to their line time; more than a percent is another exposure.
    if (std::abs(exposure - effective.exposure_us) > std::max(1.0, 0.01 * effective.exposure_us)) {
      mismatch("ExposureTime", std::to_string(effective.exposure_us), std::to_string(exposure));
    }
    effective.exposure_us = exposure;
    if (arv_camera_is_gain_available(camera_.get(), nullptr) != FALSE) {
      set_number("Gain", effective.gain_db);
      const double gain = arv_camera_get_float(camera_.get(), "Gain", error.out());
      error.check("reading Gain");
      if (std::abs(gain - effective.gain_db) > 0.1) {
        mismatch("Gain", std::to_string(effective.gain_db), std::to_string(gain));
      }
      effective.gain_db = gain;
    } else if (effective.gain_db != 0.0) {
      throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address + " has no Gain; use gain_db 0");
    }
  }

  // --- acquisition: started once and kept running; between scans nothing is triggered ---

  void start_acquisition() {
    GErrorSlot error;
    const guint payload = arv_camera_get_payload(camera_.get(), error.out());
    error.check("reading PayloadSize");
    GObjectPtr<ArvStream> stream(arv_camera_create_stream(camera_.get(), nullptr, nullptr, error.out()));
    error.check("the camera at " + config_.address + " opens no stream", ErrorCode::kCameraDisconnected);
    if (ARV_IS_GV_STREAM(stream.get())) {
      // Frames are delivered in order, so one that waits for lost packets holds up all that follow: it is given up when
      // our own deadline is over. That outlasts the exposure, for cameras that begin a frame with it.
      const auto retention = static_cast<guint>(frame_deadline().count());
      g_object_set(stream.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", 32 << 20,
                   "frame-retention", retention, nullptr);
    }
    frames_.emplace(std::move(stream), effective_.pool_frames, payload);
    counter_.restart();
    arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, error.out());
    error.check("the camera at " + config_.address + " has no continuous acquisition");
    arv_camera_start_acquisition(camera_.get(), error.out());
    error.check("the camera at " + config_.address + " does not start", ErrorCode::kCameraDisconnected);
    warm_up();
  }

  /// The receive buffer gets its size while the first frame arrives, which may be lost over it.
  void warm_up() {
    trigger();
    const auto frame = next_frame(HostClock::now() + frame_deadline());
    if (!frame) spdlog::warn("the camera at {} sent no frame for the first trigger", config_.address);
  }

  void stop_acquisition() noexcept {
    if (!frames_ || control_.lost()) return;
    GErrorSlot error;
    arv_camera_stop_acquisition(camera_.get(), error.out());
    if (error.failed()) spdlog::warn("the camera at {} did not stop: {}", config_.address, error.message());
  }

  // --- frames ---

  Frame examine(ArvBuffer* buffer) {
    Frame frame;
    frame.lease = frames_->lease(buffer);
    if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) {
      // Everything else in a failed buffer may be left over from the slot's last use.
      ++frames_failed_;
      frame.status = FrameStatus::kIncomplete;
      return frame;
    }
    std::size_t bytes = 0;
    const void* data = arv_buffer_get_data(buffer, &bytes);
    const auto expected = static_cast<std::size_t>(effective_.width) * static_cast<std::size_t>(effective_.height) *
                          static_cast<std::size_t>(bytes_per_pixel(effective_.slice_format()));
    const bool fits = arv_buffer_get_payload_type(buffer) == ARV_BUFFER_PAYLOAD_TYPE_IMAGE &&
                      arv_buffer_get_image_pixel_format(buffer) == sensor_format_info(effective_.pixel_format).pfnc &&
                      arv_buffer_get_image_width(buffer) == effective_.width &&
                      arv_buffer_get_image_height(buffer) == effective_.height && bytes >= expected;
    frame.id = counter_.unwrap(arv_buffer_get_frame_id(buffer));
    frame.status = fits ? FrameStatus::kOk : FrameStatus::kWrongGeometry;
    if (!fits) {
      ++frames_failed_;
      return frame;
    }
    ++frames_complete_;
    frame.image = {effective_.slice_format(), effective_.width, effective_.height,
                   static_cast<std::ptrdiff_t>(effective_.width) * bytes_per_pixel(effective_.slice_format()),
                   static_cast<const std::byte*>(data)};
    // The warm-up frame comes before the clock is measured; nobody looks at its time.
    frame.exposure_start = clock_.to_host(arv_buffer_get_timestamp(buffer)).value_or(HostTime::min());
    frame.exposure_end = frame.exposure_start + std::chrono::duration_cast<HostClock::duration>(
                                                    std::chrono::duration<double, std::micro>(effective_.exposure_us));
    return frame;
  }

  const CameraConfig config_;
  ControlWatch control_;  // before the camera: outlives it
  GObjectPtr<ArvCamera> camera_;
  CameraInfo info_;
  std::optional<CameraSettings> requested_;
  CameraSettings effective_;
  std::optional<FrameBuffers> frames_;
  FrameCounter counter_;
  CameraClock clock_;
  std::uint64_t frames_complete_ = 0;
  std::uint64_t frames_failed_ = 0;
  std::atomic<bool> interrupted_{false};
};

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const CameraConfig& config) {
  return std::make_unique<AravisCamera>(config);
}

}  // namespace fvd
