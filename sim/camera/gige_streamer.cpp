#include "sim/camera/gige_streamer.hpp"

#include <algorithm>
#include <utility>

#include <sys/prctl.h>

#include "core/runtime/guarded_thread.hpp"
#include "sim/camera/sensor_readout.hpp"

namespace fvd::sim {

namespace {

using std::chrono::nanoseconds;

/// Images the camera holds between sensor and line; one more is dropped at the sensor.
constexpr std::size_t kMaxHeldImages = 8;
constexpr std::size_t kTooManyBytes = 64;

nanoseconds nanoseconds_of_us(double us) { return nanoseconds(static_cast<std::int64_t>(us * 1e3)); }

/// Exposures and pacing to some ten microseconds; the kernel's default slack is 50.
void sharpen_timers() { ::prctl(PR_SET_TIMERSLACK, 1000UL, 0UL, 0UL, 0UL); }

bool is(const std::optional<CameraFaultStep>& step, CameraFault fault) { return step && step->fault == fault; }

void name_other_format(StreamFrame& frame) {
  const bool mono8 = frame.pfnc == sensor_format_info(SensorFormat::kMono8).pfnc;
  frame.pfnc = sensor_format_info(mono8 ? SensorFormat::kBayerRG8 : SensorFormat::kMono8).pfnc;
}

void pad_lines(StreamFrame& frame, int padding) {
  const std::size_t line = frame.pixels.size() / frame.height;
  std::vector<std::byte> padded;
  for (std::size_t at = 0; at < frame.pixels.size(); at += line) {
    const auto begin = frame.pixels.begin() + static_cast<std::ptrdiff_t>(at);
    padded.insert(padded.end(), begin, begin + static_cast<std::ptrdiff_t>(line));
    padded.insert(padded.end(), static_cast<std::size_t>(padding), std::byte{0xAA});
  }
  frame.pixels = std::move(padded);
  frame.x_padding = static_cast<std::uint32_t>(padding);
}

}  // namespace

GigeStreamer::GigeStreamer(FrameSource& source, CameraRegisters& registers, CameraFaultScript& faults,
                           const Standstill& mute, const Standstill& hung, GvspSender& sender,
                           std::uint64_t first_block_id, bool extended_ids, Struck struck)
    : source_(source),
      registers_(registers),
      faults_(faults),
      mute_(mute),
      hung_(hung),
      sender_(sender),
      first_block_id_(first_block_id),
      extended_ids_(extended_ids),
      struck_(std::move(struck)),
      reading_(start_thread("sim-readout", [this](std::stop_token stop) { read_out(stop); })),
      exposing_thread_(start_thread("sim-exposure", [this](std::stop_token stop) { expose(stop); })) {}

GigeStreamer::~GigeStreamer() {
  exposing_thread_.request_stop();
  reading_.request_stop();
}

std::uint64_t GigeStreamer::timestamp_ns(HostTime time) const {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<nanoseconds>(time - started_).count() + clock_ahead_ns_);
}

void GigeStreamer::set_acquiring(bool on) {
  {
    const MutexLock lock(mutex_);
    if (on && !acquiring_) next_block_id_ = first_block_id_;
    acquiring_ = on;
    triggered_ = false;
    ++acquisition_;
    exposed_.clear();
  }
  changed_.notify_all();
}

void GigeStreamer::look_again() {
  { const MutexLock lock(mutex_); }  // whoever looks at the registers now has them as they were, or waits already
  changed_.notify_all();
}

bool GigeStreamer::trigger(bool by_line) {
  const auto fault = faults_.next(CameraEvent::kTrigger);
  if (is(fault, CameraFault::kNackTrigger)) return false;
  if (is(fault, CameraFault::kIgnoreTrigger)) return true;
  if (fault) struck_(*fault);
  const CameraState state = registers_.state();
  {
    const MutexLock lock(mutex_);
    if (!acquiring_ || exposing_ || !state.triggered || state.by_line != by_line) return true;
    triggered_ = true;
  }
  changed_.notify_all();
  return true;
}

bool GigeStreamer::wait_until(HostTime time, std::uint64_t acquisition, std::stop_token stop) {
  MutexLock lock(mutex_);
  changed_.wait_until(lock, stop, time, [&] {
    mutex_.assert_held();
    return acquisition_ != acquisition;
  });
  return !stop.stop_requested() && acquisition_ == acquisition;
}

void GigeStreamer::stand_still(std::stop_token stop) {
  while (hung_.now() && !stop.stop_requested()) {
    MutexLock lock(mutex_);
    changed_.wait_until(lock, stop, hung_.end(), [] { return false; });
  }
}

// --- the sensor ---

void GigeStreamer::expose(std::stop_token stop) {
  sharpen_timers();
  HostTime next_free_run{};
  std::uint64_t free_run_of = 0;  // the acquisition
  while (!stop.stop_requested()) {
    stand_still(stop);
    HostTime start{};
    std::uint64_t acquisition = 0;
    CameraState state;
    {
      MutexLock lock(mutex_);
      const auto due = [&] {
        mutex_.assert_held();
        return acquiring_ && (triggered_ || !registers_.state().triggered);
      };
      if (!changed_.wait(lock, stop, due)) return;
      state = registers_.state();
      acquisition = acquisition_;
      if (!triggered_) {
        // A rate that cannot be held is followed as well as may be, without catching up.
        const nanoseconds period = nanoseconds_of_us(1e6 / state.frame_rate_hz);
        if (free_run_of != acquisition || next_free_run < HostClock::now() - period) next_free_run = HostClock::now();
        free_run_of = acquisition;
        const auto changes = [&] {
          mutex_.assert_held();
          return acquisition_ != acquisition || registers_.state().triggered;
        };
        if (changed_.wait_until(lock, stop, next_free_run, changes) || stop.stop_requested()) continue;
        start = std::max(next_free_run, HostClock::now() - std::chrono::milliseconds(1));
        next_free_run += period;
      } else {
        start = HostClock::now();
      }
      triggered_ = false;
      exposing_ = true;
      if (state.single_frame) acquiring_ = false;  // this frame is the last
    }
    (void)expose_one(state, start, acquisition, stop);
    const MutexLock lock(mutex_);
    exposing_ = false;
  }
}

bool GigeStreamer::expose_one(const CameraState& state, HostTime start, std::uint64_t acquisition,
                              std::stop_token stop) {
  Exposure exposure;
  exposure.state = state;
  exposure.acquisition = acquisition;
  exposure.fault = faults_.next(CameraEvent::kFrame);
  const auto& fault = exposure.fault;
  exposure.request.format = slice_format(state.format, 0);
  exposure.request.offset_x = state.offset_x;
  exposure.request.offset_y = state.offset_y;
  exposure.request.width = state.width;
  exposure.request.height = is(fault, CameraFault::kWrongSize) ? std::max(1, state.height / 2) : state.height;
  exposure.request.gain_db = state.gain_db;
  exposure.request.start = start;
  exposure.request.end = start + nanoseconds_of_us(state.exposure_us);
  exposure.request.exposure_index = exposures_++;
  {
    const MutexLock lock(mutex_);
    if (is(fault, CameraFault::kIdsRestart)) next_block_id_ = first_block_id_;
    if (is(fault, CameraFault::kIdJump)) next_block_id_ += static_cast<std::uint64_t>(fault->value);
    // GigE Vision 1.x: 16 bit, 0 is never used.
    if (!extended_ids_ && next_block_id_ > 65535) next_block_id_ -= 65535;
    exposure.block_id = next_block_id_++;
  }
  if (fault && strikes_anywhere(fault->fault)) {
    struck_(*fault);
    exposure.state.chunks = registers_.state().chunks;
  }
  if (is(fault, CameraFault::kForgetStream)) registers_.set(gvcp::reg::kStreamPort, 0);
  exposure.timestamp_ns = timestamp_ns(start);
  if (is(fault, CameraFault::kOddTime)) {
    exposure.timestamp_ns += static_cast<std::uint64_t>(nanoseconds(fault->step).count());
  }
  if (is(fault, CameraFault::kEarlyLeader) && !mute_.now()) sender_.send_leader(header_of(exposure));
  if (!wait_until(exposure.request.end, acquisition, stop)) return false;
  {
    const MutexLock lock(mutex_);
    exposing_ = false;  // before anybody can see the frame, and trigger the next
    if (acquisition_ != acquisition) return false;
    if (exposed_.size() >= kMaxHeldImages) {
      ++dropped_;
      return false;
    }
    exposed_.push_back(exposure);
  }
  changed_.notify_all();
  return true;
}

// --- the line ---

void GigeStreamer::read_out(std::stop_token stop) {
  sharpen_timers();
  while (!stop.stop_requested()) {
    Exposure exposure;
    {
      MutexLock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] {
            mutex_.assert_held();
            return !exposed_.empty();
          }))
        return;
      exposure = exposed_.front();
      exposed_.pop_front();
    }
    stand_still(stop);
    send(exposure, stop);
  }
}

StreamFrame GigeStreamer::header_of(const Exposure& exposure) const {
  StreamFrame frame;
  frame.block_id = exposure.block_id;
  frame.extended_ids = extended_ids_;
  frame.timestamp_ns = exposure.timestamp_ns;
  frame.pfnc = sensor_format_info(exposure.state.format).pfnc;
  frame.width = static_cast<std::uint32_t>(exposure.request.width);
  frame.height = static_cast<std::uint32_t>(exposure.request.height);
  frame.offset_x = static_cast<std::uint32_t>(exposure.state.offset_x);
  frame.offset_y = static_cast<std::uint32_t>(exposure.state.offset_y);
  frame.to_address = exposure.state.stream_address;
  frame.to_port = exposure.state.stream_port;
  frame.packet_size = exposure.state.packet_size;
  frame.delay_ns = exposure.state.packet_delay_ns;
  frame.chunks = exposure.state.chunks;
  return frame;
}

std::shared_ptr<StreamFrame> GigeStreamer::develop(const Exposure& exposure) {
  auto frame = sender_.spare();
  std::vector<std::byte> pixels = std::move(frame->pixels);
  *frame = header_of(exposure);
  const ExposureRequest& request = exposure.request;
  pixels.resize(sensor_image_bytes(exposure.state.format, request.width, request.height));
  if (needs_readout(exposure.state.format)) {
    image_.resize(static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height) *
                  static_cast<std::size_t>(bytes_per_pixel(request.format)));
    source_.render(request, image_);
    sim::read_out(exposure.state.format, image_, request.width, request.offset_x, request.offset_y, pixels);
  } else {
    source_.render(request, pixels);
  }
  if (is(exposure.fault, CameraFault::kTooLong)) pixels.resize(pixels.size() + kTooManyBytes);
  frame->pixels = std::move(pixels);
  return frame;
}

void GigeStreamer::send(const Exposure& exposure, std::stop_token stop) {
  const auto& fault = exposure.fault;
  std::shared_ptr<StreamFrame> frame = develop(exposure);
  if (is(fault, CameraFault::kStaleFrame) && before_ && before_->pfnc == frame->pfnc &&
      before_->width == frame->width && before_->height == frame->height) {
    std::copy_n(before_->pixels.begin(), frame->pixels.size(), frame->pixels.begin());  // without its chunks
    frame->timestamp_ns = before_->timestamp_ns;
  }
  if (is(fault, CameraFault::kDarkFrame) || is(fault, CameraFault::kHalfFrame)) {
    const std::size_t lit = is(fault, CameraFault::kHalfFrame) ? frame->pixels.size() / 2 : 0;
    std::fill(frame->pixels.begin() + static_cast<std::ptrdiff_t>(lit), frame->pixels.end(), std::byte{0});
  }
  if (is(fault, CameraFault::kOtherFormat)) name_other_format(*frame);
  if (is(fault, CameraFault::kPaddedLines)) pad_lines(*frame, fault->value);
  if (frame->chunks != ChunkMode::kOff) gvsp::append_chunks(*frame, exposure.state.exposure_us);
  if (is(fault, CameraFault::kLateFrame) && !wait_until(HostClock::now() + fault->delay, exposure.acquisition, stop)) {
    return;
  }
  {
    const MutexLock lock(mutex_);
    if (acquisition_ != exposure.acquisition) return;
  }
  if (mute_.now() || frame->to_port == 0) return;
  ++frames_;
  before_ = frame;
  if (is(fault, CameraFault::kDropFrame)) return;
  Sending what;
  what.leader = !is(fault, CameraFault::kDropLeader) && !is(fault, CameraFault::kEarlyLeader);
  what.trailer = !is(fault, CameraFault::kDropTrailer);
  what.reordered = is(fault, CameraFault::kReorderPackets);
  if (is(fault, CameraFault::kDropPacket)) {
    what.without = gvsp::trailer_id(*frame) / 2;
    if (fault->value == 1) frame->gone.insert(what.without);
  }
  sender_.send(frame, what);
  if (is(fault, CameraFault::kDuplicateFrame)) sender_.send(frame, {});
}

}  // namespace fvd::sim
