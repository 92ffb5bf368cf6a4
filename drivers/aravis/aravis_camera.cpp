#include "drivers/aravis/aravis_camera.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <arpa/inet.h>
#include <arv.h>
#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/image/unpack.hpp"
#include "drivers/aravis/camera_clock.hpp"
#include "drivers/aravis/camera_features.hpp"
#include "drivers/aravis/control_watch.hpp"
#include "drivers/aravis/device_thread.hpp"
#include "drivers/aravis/frame_buffers.hpp"
#include "drivers/aravis/frame_check.hpp"
#include "drivers/aravis/frame_counter.hpp"
#include "drivers/aravis/gige_transport.hpp"
#include "drivers/aravis/gobject.hpp"
#include "drivers/aravis/gvcp_probe.hpp"
#include "drivers/aravis/slice_pool.hpp"

namespace fvd {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// A wait for a frame looks up so often whether it was interrupted.
constexpr microseconds kWaitSlice{10000};
/// A command that is not acknowledged by then: is the camera still there?
constexpr milliseconds kAcknowledged{100};
/// A frame that is late by so much: is the camera still there?
constexpr milliseconds kOverdue{20};
/// Nobody tells when the edge of a trigger line comes.
constexpr milliseconds kQuietLine{500};
/// A camera that answers nothing for so long is gone. GigE Vision lets it take 200 ms for an answer.
constexpr milliseconds kSilence{200};
/// How far the map of the camera's clock may be wrong when an exposure is told from one under older settings.
constexpr microseconds kClockTolerance{200};
/// Without a latch the clock is taken from the quickest of so many triggers.
constexpr int kClockTriggers = 5;
/// A link slower than half a gigabit is no camera link.
constexpr double kSlowestLink_us_per_byte = 0.02;

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

microseconds rounded_up_us(double us) { return microseconds(static_cast<std::int64_t>(std::ceil(us))); }

bool same_shape(const CameraSettings& a, const CameraSettings& b) {
  return a.pixel_format == b.pixel_format && a.significant_bits == b.significant_bits && a.bayer == b.bayer &&
         a.width == b.width && a.height == b.height && a.offset_x == b.offset_x && a.offset_y == b.offset_y &&
         a.pool_frames == b.pool_frames;
}

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

class AravisCamera final : public Camera {
 public:
  AravisCamera(const CameraConfig& config, milliseconds clock_renewal) : config_(config), clock_(clock_renewal) {
    require_presence();
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
    features_.emplace(camera_.get(), config.address);
    read_info();
    if (arv_camera_is_gv_device(camera_.get())) {
      open_probe();
      set_packet_size(camera_.get(), *features_, config_);
      warn_of_system_limits(config_.packet_socket);
    } else if (arv_camera_is_uv_device(camera_.get())) {
      arv_camera_uv_set_usb_mode(camera_.get(),
                                 config_.usb_mode == "async" ? ARV_UV_USB_MODE_ASYNC : ARV_UV_USB_MODE_SYNC);
    }
  }

  ~AravisCamera() override {
    device_.reset();  // from here on nobody else talks to the camera
    stop_acquisition();
    frames_.reset();
  }

  [[nodiscard]] CameraInfo info() const override { return info_; }

  CameraSettings configure(const CameraSettings& settings) override {
    check(settings);
    return command([this, settings] {
      if (!requested_ || *requested_ != settings) change_to(settings);
      renew_clock();
      if (!latches_) take_clock_from_triggers();
      return effective_;
    });
  }

  void trigger() override {
    require_connected();
    while (trigger_.valid() && !acknowledged()) require_life();
    quiet_since_ = HostClock::now();
    trigger_ = device_->post(answering([this] {
      send_trigger();
      return true;
    }));
    renew_clock_if_due();
    if (!acknowledged()) require_life();  // an acknowledge may get lost; the frame comes all the same
  }

  [[nodiscard]] std::optional<Frame> next_frame(HostTime deadline) override {
    Question question;
    for (;;) {
      const HostTime now = HostClock::now();
      const auto left = std::chrono::duration_cast<microseconds>(std::max(deadline, now) - now);
      ArvBuffer* buffer = frames_ ? frames_->pop(std::min(std::max(left, question.wait()), kWaitSlice)) : nullptr;
      if (buffer != nullptr) {
        if (auto frame = examine(buffer)) return frame;
        continue;
      }
      if (interrupted_.exchange(false)) return std::nullopt;
      require_connected();
      if (left > microseconds(0) || question.open) watch_over(question);
      if (HostClock::now() >= deadline && !question.open) return std::nullopt;
    }
  }

  [[nodiscard]] std::chrono::microseconds frame_deadline() const override {
    return longest_frame_time() + milliseconds(config_.frame_margin_ms);
  }

  void interrupt() noexcept override { interrupted_ = true; }

  [[nodiscard]] bool connected() const noexcept override { return !control_.lost(); }

  [[nodiscard]] CameraHealth health() const override {
    CameraHealth health;
    health.frames_complete = frames_complete_;
    health.frames_failed = frames_failed_;
    health.ids_skipped = ids_skipped_;
    if (control_.lost() || !frames_) return health;
    guint64 completed = 0;
    guint64 failures = 0;
    guint64 underruns = 0;
    arv_stream_get_statistics(frames_->stream(), &completed, &failures, &underruns);
    health.underruns = underruns + underruns_;
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
  // --- is it there? ---

  /// Aravis would look for a camera that is away for seconds.
  void require_presence() {
    if (config_.address.empty()) {
      throw Error(ErrorCode::kBadConfig,
                  "the camera's address is empty: give its IP address or vendor-model-serial in /camera/address");
    }
    if (!is_ipv4(config_.address)) return;
    GvcpProbe probe(config_.address);
    switch (probe.ask(2 * kSilence)) {
      case GvcpProbe::Answer::kFree:
        return;
      case GvcpProbe::Answer::kControlled:
        throw_controlled();
      case GvcpProbe::Answer::kNone:
      case GvcpProbe::Answer::kAbsent:
        throw Error(ErrorCode::kCameraDisconnected, "no camera answers at " + config_.address +
                                                        "; is it powered, in this network, and its address "
                                                        "right?");
    }
  }

  [[noreturn]] void throw_controlled() const {
    throw Error(ErrorCode::kCameraDisconnected,
                "the camera at " + config_.address +
                    " is controlled by another program, or by one that died less than its heartbeat timeout ago");
  }

  void require_control() const {
    if (!arv_camera_is_gv_device(camera_.get()) ||
        arv_gv_device_is_controller(ARV_GV_DEVICE(control_.device())) != FALSE)
      return;
    throw_controlled();
  }

  void open_probe() {
    GSocketAddress* address = arv_gv_device_get_device_address(ARV_GV_DEVICE(control_.device()));
    const std::unique_ptr<char, decltype(&g_free)> ip(
        g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address))), &g_free);
    probe_.emplace(ip.get());
    if (probe_->ask(2 * kSilence) == GvcpProbe::Answer::kControlled) return;
    spdlog::warn("the camera at {} answers its controller only; its loss will be noticed late", config_.address);
    probe_.reset();
  }

  void require_connected() const {
    if (!control_.lost()) return;
    throw Error(ErrorCode::kCameraDisconnected, "the connection to the camera at " + config_.address +
                                                    " is lost: " + loss_ + "; it is being opened again");
  }

  [[noreturn]] void lose(const char* why) {
    loss_ = why;
    control_.set_lost();
    require_connected();
    throw Error(ErrorCode::kInternal, "a lost camera is connected");
  }

  /// Throws if the answer says that the camera is lost; true once it says that it is not.
  bool judge(GvcpProbe::Answer answer) {
    switch (answer) {
      case GvcpProbe::Answer::kControlled:
        return true;
      case GvcpProbe::Answer::kFree:
        lose("nobody controls it any more, as after a restart");
      case GvcpProbe::Answer::kAbsent:
        lose("its host says that nobody listens there");
      case GvcpProbe::Answer::kNone:
        break;
    }
    return false;
  }

  /// For commands that take too long. Throws Error kCameraDisconnected if the camera does not answer.
  void require_life() {
    require_connected();
    if (probe_ && !judge(probe_->ask(kSilence))) lose("it answers nothing; check power and cable");
  }

  /// The question whether a silent camera is alive, asked while its frames are waited for.
  struct Question {
    bool open = false;
    HostTime asked{};
    [[nodiscard]] microseconds wait() const { return open ? kWaitSlice : microseconds(0); }
  };

  void watch_over(Question& question) {
    const HostTime now = HostClock::now();
    if (!question.open) {
      if (!probe_ || now < quiet_since_ + longest_frame_time() + kOverdue) return;
      probe_->begin();
      question = {true, now};
    }
    if (judge(probe_->look())) {
      question.open = false;
      quiet_since_ = now;
      resynchronise();
    } else if (now - question.asked >= kSilence) {
      lose("it answers nothing; check power and cable");
    }
  }

  /// A camera that began to count anew: Aravis takes its frames for late ones and throws them away.
  void resynchronise() {
    const std::uint64_t ignored = frames_->ignored_packets();
    if (ignored == ignored_packets_) return;
    spdlog::warn("the camera at {} counts its frames anew; the stream is started anew", config_.address);
    frames_->restart_thread();
    counter_.restart();
    ignored_packets_ = frames_->ignored_packets();
  }

  // --- commands ---

  /// Runs it on the device's thread and waits for as long as the camera is alive. What the command refers to must not
  /// be of the caller's frame: it may outlast the wait.
  template <typename Command>
  auto command(Command run) -> decltype(run()) {
    require_connected();
    auto result = device_->post(answering(std::move(run)));
    while (result.wait_for(kAcknowledged) != std::future_status::ready) require_life();
    auto answer = result.get();
    if (answer.value) return std::move(*answer.value);
    if (answer.code == ErrorCode::kCameraDisconnected) control_.set_lost();
    throw Error(answer.code, answer.message);
  }

  /// True once the last trigger was answered.
  bool acknowledged() {
    if (trigger_.wait_for(kAcknowledged) != std::future_status::ready) return false;
    const auto answer = trigger_.get();
    if (answer.value) return true;
    if (answer.code == ErrorCode::kCameraDisconnected) {
      control_.set_lost();
      throw Error(answer.code, answer.message);
    }
    // There, but busy: no frame comes, and the caller's deadline tells.
    spdlog::warn("{}", answer.message);
    return true;
  }

  void send_trigger() {
    GErrorSlot error;
    arv_camera_software_trigger(camera_.get(), error.out());
    error.check("the camera at " + config_.address + " takes no trigger");
  }

  void read_info() {
    const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
    GErrorSlot error;
    info_.vendor = text(arv_camera_get_vendor_name(camera_.get(), error.out()));
    info_.model = text(arv_camera_get_model_name(camera_.get(), error.out()));
    info_.serial = text(arv_camera_get_device_serial_number(camera_.get(), error.out()));
    info_.address = config_.address;
    features_->sensor_size(info_.sensor_width, info_.sensor_height);
    info_.simulated = config_.simulated || (info_.vendor == "fvd" && info_.model == "SimulatedCamera");
  }

  // --- settings and acquisition, on the device's thread ---

  void change_to(const CameraSettings& settings) {
    const auto before = std::exchange(requested_, std::nullopt);
    if (!before || !frames_ || !same_shape(*before, settings) || !change_timing(settings)) rebuild(settings);
    requested_ = settings;
    configured_ = HostClock::now();
    quiet_since_ = configured_;
  }

  /// While the camera goes on acquiring. False if it does not take that.
  bool change_timing(const CameraSettings& settings) {
    try {
      features_->apply_timing(settings, effective_);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kCameraSettings) throw;
      return false;
    }
    set_stream_options(frames_->stream(), stream_times());
    return true;
  }

  void rebuild(const CameraSettings& settings) {
    stop_acquisition();
    frames_.reset();
    effective_ = features_->apply_shape(settings);
    // Warmed up by software, whatever triggers later.
    CameraSettings warm = settings;
    warm.trigger = TriggerMode::kSoftware;
    features_->apply_timing(warm, effective_);
    start_acquisition();
    (void)warm_up();
    if (settings.trigger == TriggerMode::kSoftware) return;
    features_->apply_timing(settings, effective_);
    set_stream_options(frames_->stream(), stream_times());
  }

  void start_acquisition() {
    GErrorSlot error;
    const guint payload = arv_camera_get_payload(camera_.get(), error.out());
    error.check("reading PayloadSize");
    const std::size_t image = sensor_image_bytes(effective_.pixel_format, effective_.width, effective_.height);
    if (payload < image) {
      throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address + " announces a PayloadSize of " +
                                                  std::to_string(payload) + " bytes, its image takes " +
                                                  std::to_string(image));
    }
    GObjectPtr<ArvStream> stream(arv_camera_create_stream(camera_.get(), &AravisCamera::on_stream,
                                                          const_cast<CameraConfig*>(&config_), error.out()));
    error.check("the camera at " + config_.address + " opens no stream", ErrorCode::kCameraDisconnected);
    set_stream_options(stream.get(), stream_times());
    frames_.emplace(std::move(stream), effective_.pool_frames, payload);
    slices_.reset();
    if (needs_unpacking(effective_.pixel_format, effective_.significant_bits)) {
      slices_ = std::make_unique<SlicePool>(effective_.pool_frames,
                                            static_cast<std::size_t>(effective_.width) *
                                                static_cast<std::size_t>(effective_.height) *
                                                static_cast<std::size_t>(bytes_per_pixel(effective_.slice_format())));
    }
    counter_.restart();
    ignored_packets_ = 0;
    arv_camera_start_acquisition(camera_.get(), error.out());
    error.check("the camera at " + config_.address + " does not start", ErrorCode::kCameraDisconnected);
  }

  /// The receive buffer gets its size while the first frame arrives, which may be lost over it. Returns the camera's
  /// time of the frame, 0 if none came.
  std::uint64_t warm_up() {
    send_trigger();
    const HostTime deadline = HostClock::now() + frame_deadline();
    while (HostClock::now() < deadline && !control_.lost()) {
      ArvBuffer* buffer = frames_->pop(kWaitSlice);
      if (buffer == nullptr) continue;
      const bool good = check_frame(buffer, effective_) == FrameStatus::kOk;
      if (good) (void)counter_.unwrap(arv_buffer_get_frame_id(buffer));
      const std::uint64_t camera_ns = good ? arv_buffer_get_timestamp(buffer) : 0;
      frames_->recycle(buffer);
      return camera_ns;
    }
    spdlog::warn("the camera at {} sent no frame for the first trigger", config_.address);
    return 0;
  }

  void stop_acquisition() noexcept {
    if (!frames_ || control_.lost()) return;
    GErrorSlot error;
    arv_camera_stop_acquisition(camera_.get(), error.out());
    if (error.failed()) spdlog::warn("the camera at {} did not stop: {}", config_.address, error.message());
  }

  /// In the thread that receives, before it begins.
  static void on_stream(void* config, ArvStreamCallbackType type, ArvBuffer* /*buffer*/) {
    const int priority = static_cast<const CameraConfig*>(config)->stream_priority;
    if (type != ARV_STREAM_CALLBACK_TYPE_INIT || priority == 0) return;
    if (!arv_make_thread_realtime(priority)) {
      spdlog::info("frames are received without real-time priority: the process lacks CAP_SYS_NICE");
    }
  }

  void renew_clock() {
    if (!clock_.due(HostClock::now())) return;
    const auto pair = latch_clock(control_.device());
    latches_ = pair.has_value();
    if (pair) clock_.add(*pair);
  }

  /// For cameras without a latch: an exposure starts after its trigger was sent, so taking the quickest of some
  /// triggers and its exposure for one moment dates every exposure early by that trigger's latency, and never an old
  /// one as new.
  void take_clock_from_triggers() {
    if (effective_.trigger != TriggerMode::kSoftware) {
      throw Error(ErrorCode::kCameraSettings,
                  "the camera at " + config_.address +
                      " can latch no timestamp, so that its frames cannot be dated well enough for a scan without "
                      "software triggers; use scan.mode step with scan.trigger software");
    }
    if (!clock_.due(HostClock::now())) return;
    std::optional<ClockPair> best;
    for (int i = 0; i < kClockTriggers; ++i) {
      const HostTime triggered = HostClock::now();
      const auto camera_ns = static_cast<std::int64_t>(warm_up());
      if (camera_ns == 0) continue;
      const ClockPair pair{camera_ns, triggered, std::chrono::milliseconds(1)};
      if (!best || pair.host - best->host > std::chrono::nanoseconds(pair.camera_ns - best->camera_ns)) best = pair;
    }
    if (best) {
      if (!clock_.known()) {
        spdlog::warn("the camera at {} has no timestamp latch; its clock is taken from triggers", config_.address);
      }
      clock_.add(*best);
      return;
    }
    throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address +
                                                " can latch no timestamp and dates no triggered frame: a late frame "
                                                "could not be told from a fresh one, and heights would be wrong");
  }

  void renew_clock_if_due() {
    // First: until the renewal is done, the device's thread writes latches_.
    if (renewal_.valid() && renewal_.wait_for(milliseconds(0)) != std::future_status::ready) return;
    if (!latches_ || !clock_.due(HostClock::now())) return;
    renewal_ = device_->post([this] { renew_clock(); });
  }

  // --- frames ---

  [[nodiscard]] microseconds readout() const {
    return rounded_up_us(kSlowestLink_us_per_byte * static_cast<double>(sensor_image_bytes(
                                                        effective_.pixel_format, effective_.width, effective_.height)));
  }

  /// From the moment that starts or may start an exposure until its frame is there, if nothing goes wrong.
  [[nodiscard]] microseconds longest_frame_time() const {
    const microseconds frame = rounded_up_us(effective_.exposure_us) + readout();
    switch (effective_.trigger) {
      case TriggerMode::kSoftware:
        return frame;
      case TriggerMode::kLine:
        return frame + kQuietLine;
      case TriggerMode::kFreeRun:
        return frame + rounded_up_us(1e6 / std::max(effective_.frame_rate_hz, 0.01));
    }
    return frame;
  }

  [[nodiscard]] StreamTimes stream_times() const {
    return {rounded_up_us(effective_.exposure_us), readout(),
            rounded_up_us(effective_.exposure_us) + readout() + milliseconds(config_.frame_margin_ms)};
  }

  /// Nothing for a frame of the settings before.
  std::optional<Frame> examine(ArvBuffer* buffer) {
    Frame frame;
    frame.lease = frames_->lease(buffer);
    quiet_since_ = HostClock::now();
    frame.status = check_frame(buffer, effective_);
    if (frame.status == FrameStatus::kIncomplete) {
      // Everything but the status may be left over from the slot's last use.
      ++frames_failed_;
      ++failed_since_good_;
      return frame;
    }
    const std::uint64_t last = counter_.last();
    frame.id = counter_.unwrap(arv_buffer_get_frame_id(buffer));
    if (frame.id > last + 1) ids_skipped_ += frame.id - last - 1 - std::min(frame.id - last - 1, failed_since_good_);
    failed_since_good_ = 0;
    if (frame.status != FrameStatus::kOk) {
      ++frames_failed_;
      return frame;
    }
    frame.exposure_start = clock_.to_host(arv_buffer_get_timestamp(buffer)).value_or(HostTime::min());
    frame.exposure_end = frame.exposure_start + std::chrono::duration_cast<HostClock::duration>(
                                                    std::chrono::duration<double, std::micro>(effective_.exposure_us));
    if (frame.exposure_start < configured_ - kClockTolerance) return std::nullopt;
    ignored_packets_ = frames_->ignored_packets();
    const std::byte* pixels = wire_image(buffer, effective_).data();
    if (slices_) {
      FrameLease slot = slices_->borrow();
      if (!slot) {
        ++underruns_;
        ++frames_failed_;
        frame.status = FrameStatus::kIncomplete;
        return frame;
      }
      unpack({effective_.pixel_format, effective_.significant_bits, effective_.bayer, effective_.width,
              effective_.height, wire_image(buffer, effective_)},
             slices_->bytes(slot));
      pixels = slices_->bytes(slot).data();
      frame.lease = std::move(slot);  // gives the buffer back
    }
    ++frames_complete_;
    frame.image = {effective_.slice_format(), effective_.width, effective_.height,
                   static_cast<std::ptrdiff_t>(effective_.width) * bytes_per_pixel(effective_.slice_format()), pixels};
    renew_clock_if_due();
    return frame;
  }

  const CameraConfig config_;
  ControlWatch control_;  // before the camera: outlives it
  GObjectPtr<ArvCamera> camera_;
  std::optional<CameraFeatures> features_;
  std::optional<GvcpProbe> probe_;  // nothing: not GigE Vision, or it answers its controller only
  CameraInfo info_;
  std::string loss_ = "its heartbeat failed; check power and cable";

  // Written by commands, read by the caller once they are done.
  std::optional<CameraSettings> requested_;
  CameraSettings effective_;
  std::optional<FrameBuffers> frames_;
  std::unique_ptr<SlicePool> slices_;  // nothing: slices are what comes over the wire
  FrameCounter counter_;
  HostTime configured_{};
  HostTime quiet_since_{};             // last thing heard or asked of the camera
  std::uint64_t ignored_packets_ = 0;  // by Aravis, up to the last good frame

  CameraClock clock_;
  bool latches_ = true;  // its clock for us; the renewal writes it, the caller reads it when that is done
  std::uint64_t frames_complete_ = 0;
  std::uint64_t frames_failed_ = 0;
  std::uint64_t failed_since_good_ = 0;
  std::uint64_t ids_skipped_ = 0;
  std::uint64_t underruns_ = 0;  // of slices
  std::atomic<bool> interrupted_{false};
  std::future<Answer<bool>> trigger_;
  std::future<void> renewal_;
  std::unique_ptr<DeviceThread> device_ = std::make_unique<DeviceThread>();
};

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const CameraConfig& config, std::chrono::milliseconds clock_renewal) {
  return std::make_unique<AravisCamera>(config, clock_renewal);
}

}  // namespace fvd
