#include "drivers/aravis/acquisition.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "drivers/aravis/gobject.hpp"

namespace fvd {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Length of one wait for the first frame, between looks at the connection.
constexpr microseconds kWarmUpWait{10000};
/// The time of a line trigger is unknown; wait this long before the camera is asked whether it is alive.
constexpr milliseconds kLineTriggerGrace{500};
/// Without a latch the clock is taken from the quickest of this many triggers.
constexpr int kClockTriggers = 5;
/// A link slower than half a gigabit is no camera link.
constexpr double kSlowestLink_us_per_byte = 0.02;

microseconds rounded_up_us(double us) { return microseconds(static_cast<std::int64_t>(std::ceil(us))); }

bool same_shape(const CameraSettings& a, const CameraSettings& b) {
  return a.pixel_format == b.pixel_format && a.significant_bits == b.significant_bits && a.bayer == b.bayer &&
         a.width == b.width && a.height == b.height && a.offset_x == b.offset_x && a.offset_y == b.offset_y &&
         a.pool_frames == b.pool_frames;
}

/// Called in the thread that receives frames, before it begins.
void on_stream(void* config, ArvStreamCallbackType type, ArvBuffer* /*buffer*/) {
  const int priority = static_cast<const CameraConfig*>(config)->stream_priority;
  if (type != ARV_STREAM_CALLBACK_TYPE_INIT || priority == 0) return;
  if (!arv_make_thread_realtime(priority)) {
    spdlog::info("frames are received without real-time priority: the process lacks CAP_SYS_NICE");
  }
}

}  // namespace

Acquisition::Acquisition(ArvCamera* camera, const CameraConfig& config, const CameraFeatures& features,
                         const CameraPresence& presence, milliseconds clock_renewal)
    : camera_(camera), config_(config), features_(features), presence_(presence), clock_(clock_renewal) {}

Acquisition::~Acquisition() { stop(); }

void Acquisition::configure(const CameraSettings& settings) {
  intake_.forget_refusal();
  if (!requested_ || *requested_ != settings) change_to(settings);
  renew_clock();
  if (!latches_) take_clock_from_triggers();
}

void Acquisition::change_to(const CameraSettings& settings) {
  const auto before = std::exchange(requested_, std::nullopt);
  if (!before || !frames_ || !same_shape(*before, settings) || !change_timing(settings)) rebuild(settings);
  requested_ = settings;
  configured_ = HostClock::now();
}

/// While the camera goes on acquiring. False if it does not take that.
bool Acquisition::change_timing(const CameraSettings& settings) {
  try {
    features_.apply_timing(settings, in_force_);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kCameraSettings) throw;
    return false;
  }
  set_stream_options(frames_->stream(), stream_times());
  return true;
}

void Acquisition::rebuild(const CameraSettings& settings) {
  stop();
  frames_.reset();
  in_force_ = features_.apply_shape(settings);
  // Warmed up by software, whatever triggers later.
  CameraSettings warm = settings;
  warm.trigger = TriggerMode::kSoftware;
  features_.apply_timing(warm, in_force_);
  start();
  (void)warm_up();
  if (settings.trigger == TriggerMode::kSoftware) return;
  features_.apply_timing(settings, in_force_);
  set_stream_options(frames_->stream(), stream_times());
}

void Acquisition::start() {
  GErrorSlot error;
  const guint payload = arv_camera_get_payload(camera_, error.out());
  error.check("reading PayloadSize");
  const std::size_t image = sensor_image_bytes(in_force_.pixel_format, in_force_.width, in_force_.height);
  if (payload < image) {
    throw Error(ErrorCode::kCameraSettings, "the camera at " + config_.address + " announces a PayloadSize of " +
                                                std::to_string(payload) + " bytes, its image takes " +
                                                std::to_string(image));
  }
  GObjectPtr<ArvStream> stream(
      arv_camera_create_stream(camera_, &on_stream, const_cast<CameraConfig*>(&config_), error.out()));
  error.check("the camera at " + config_.address + " opens no stream", ErrorCode::kCameraDisconnected);
  set_stream_options(stream.get(), stream_times());
  frames_.emplace(std::move(stream), in_force_.pool_frames, payload);
  intake_.begin_stream(in_force_);
  ignored_packets_ = 0;
  arv_camera_start_acquisition(camera_, error.out());
  error.check("the camera at " + config_.address + " does not start", ErrorCode::kCameraDisconnected);
}

void Acquisition::stop() noexcept {
  if (!frames_ || presence_.lost()) return;
  GErrorSlot error;
  arv_camera_stop_acquisition(camera_, error.out());
  if (error.failed()) spdlog::warn("the camera at {} did not stop: {}", config_.address, error.message());
}

/// The receive buffer gets its size while the first frame arrives, which may be lost over it. Returns the time of the
/// frame on the camera's clock in ns, 0 if none came.
std::uint64_t Acquisition::warm_up() {
  send_trigger();
  const HostTime deadline = HostClock::now() + frame_deadline();
  while (HostClock::now() < deadline && !presence_.lost()) {
    ArvBuffer* buffer = frames_->pop(kWarmUpWait);
    if (buffer != nullptr) return intake_.discard(*frames_, buffer, in_force_);
  }
  spdlog::warn("the camera at {} sent no frame for the first trigger", config_.address);
  return 0;
}

void Acquisition::send_trigger() {
  GErrorSlot error;
  arv_camera_software_trigger(camera_, error.out());
  error.check("the camera at " + config_.address + " takes no trigger");
}

void Acquisition::renew_clock() {
  if (clock_.due(HostClock::now())) latch();
}

void Acquisition::renew_clock_early() {
  if (clock_.due_soon(HostClock::now())) latch();
}

void Acquisition::latch() {
  const auto pair = latch_clock(presence_.device());
  latches_ = pair.has_value();
  if (pair) return clock_.add(*pair);
  clock_.doubt();  // a command may have been lost: the next configure() tries again, also before the clock is old
}

/// For cameras without a latch: an exposure starts after its trigger was sent, so taking the quickest of some triggers
/// and its exposure for one moment dates every exposure early by that trigger's latency, and never an old one as new.
void Acquisition::take_clock_from_triggers() {
  if (in_force_.trigger != TriggerMode::kSoftware) {
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
    const ClockPair pair{camera_ns, triggered, milliseconds(1)};
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

ArvBuffer* Acquisition::pop(microseconds timeout) { return frames_ ? frames_->pop(timeout) : nullptr; }

std::optional<Frame> Acquisition::take(ArvBuffer* buffer) {
  auto frame = intake_.take(*frames_, buffer, in_force_, configured_);
  if (frame && frame->status == FrameStatus::kOk) ignored_packets_ = frames_->ignored_packets();
  return frame;
}

void Acquisition::resynchronise() {
  if (!frames_) return;
  const std::uint64_t ignored = frames_->ignored_packets();
  if (ignored == ignored_packets_) return;
  spdlog::warn("the camera at {} counts its frames anew; the stream is started anew", config_.address);
  frames_->restart_thread();
  intake_.restart_count();
  ignored_packets_ = frames_->ignored_packets();
}

microseconds Acquisition::readout() const {
  const std::size_t bytes = sensor_image_bytes(in_force_.pixel_format, in_force_.width, in_force_.height);
  return rounded_up_us(kSlowestLink_us_per_byte * static_cast<double>(bytes));
}

microseconds Acquisition::longest_frame_time() const {
  const microseconds frame = rounded_up_us(in_force_.exposure_us) + readout();
  switch (in_force_.trigger) {
    case TriggerMode::kSoftware:
      return frame;
    case TriggerMode::kLine:
      return frame + kLineTriggerGrace;
    case TriggerMode::kFreeRun:
      return frame + rounded_up_us(1e6 / std::max(in_force_.frame_rate_hz, 0.01));
  }
  return frame;
}

microseconds Acquisition::frame_deadline() const {
  return longest_frame_time() + milliseconds(config_.frame_margin_ms);
}

StreamTimes Acquisition::stream_times() const {
  const microseconds exposure = rounded_up_us(in_force_.exposure_us);
  return {exposure, readout(), exposure + readout() + milliseconds(config_.frame_margin_ms)};
}

CameraHealth Acquisition::health() const {
  CameraHealth health;
  intake_.count_into(health);
  if (presence_.lost() || !frames_) return health;
  guint64 completed = 0;
  guint64 failures = 0;
  guint64 underruns = 0;
  arv_stream_get_statistics(frames_->stream(), &completed, &failures, &underruns);
  health.underruns += underruns;
  if (ARV_IS_GV_STREAM(frames_->stream())) {
    guint64 resent = 0;
    guint64 missing = 0;
    arv_gv_stream_get_statistics(ARV_GV_STREAM(frames_->stream()), &resent, &missing);
    health.packets_resent = resent;
    health.packets_missing = missing;
  }
  return health;
}

}  // namespace fvd
