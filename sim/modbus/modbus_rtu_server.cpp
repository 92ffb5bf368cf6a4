#include "sim/modbus/modbus_rtu_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <stop_token>
#include <thread>

#include <poll.h>
#include <sys/eventfd.h>

#include "core/base/clock.hpp"
#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "sim/base/file_descriptor.hpp"
#include "sim/base/pseudo_terminal.hpp"
#include "sim/modbus/scripted_responder.hpp"

namespace fvd::sim {

namespace {

using std::chrono::nanoseconds;

constexpr std::size_t kSmallestFrame = 4;  // unit, function, checksum
constexpr std::size_t kLargestFrame = 256;
constexpr int kBitsPerCharacter = 11;

}  // namespace

struct ModbusRtuServer::Impl {
  Impl(RegisterBank& bank, const ModbusRtuOptions& o)
      : options(checked(o)),
        responder(bank, o.faults, o.drive),
        terminal(o.link),
        wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        thread(start_thread("sim-modbus-rtu", [this](std::stop_token stop) { serve(stop); })) {}

  ~Impl() {
    thread.request_stop();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake.get(), &one, sizeof(one));
  }

  static const ModbusRtuOptions& checked(const ModbusRtuOptions& options) {
    const LineTiming& t = options.timing;
    const bool fits = options.unit >= 1 && options.unit <= 247 && t.baud >= 1200 && t.baud <= 4'000'000 &&
                      std::min({t.turnaround, t.usb_latency, t.inter_frame, t.frame_silence}).count() >= 0;
    if (!fits) throw Error(ErrorCode::kBadConfig, "the simulated serial line: unit, baud or a time is out of range");
    return options;
  }

  [[nodiscard]] nanoseconds characters(double count) const {
    return nanoseconds(static_cast<std::int64_t>(1e9 * kBitsPerCharacter * count / options.timing.baud));
  }

  [[nodiscard]] nanoseconds frame_silence() const {
    return std::max(characters(3.5), nanoseconds(options.timing.frame_silence));
  }

  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const bool waits_for_more = !input.empty() || astray;
      const bool readable = wait_readable(waits_for_more ? frame_silence() : idle_period());
      terminal.end_exclusive_use();
      responder.idle();
      if (readable) {
        take_input(stop);
      } else if (waits_for_more) {
        end_by_silence(stop);
      }
    }
  }

  static nanoseconds idle_period() { return std::chrono::milliseconds(RegisterBank::kIdlePeriodMs); }

  /// False when nothing came, or the server is to end.
  bool wait_readable(nanoseconds timeout) {
    std::array<pollfd, 2> waiting{{{wake.get(), POLLIN, 0}, {terminal.master(), POLLIN, 0}}};
    const timespec time{timeout.count() / 1'000'000'000, timeout.count() % 1'000'000'000};
    return ::ppoll(waiting.data(), waiting.size(), &time, nullptr) > 0 && (waiting[1].revents & POLLIN) != 0;
  }

  void wait_until(HostTime deadline, const std::stop_token& stop) {
    for (auto left = deadline - HostClock::now(); left.count() > 0 && !stop.stop_requested();
         left = deadline - HostClock::now()) {
      pollfd waiting{wake.get(), POLLIN, 0};
      const nanoseconds ns = left;
      const timespec time{ns.count() / 1'000'000'000, ns.count() % 1'000'000'000};
      ::ppoll(&waiting, 1, &time, nullptr);
    }
  }

  void take_input(const std::stop_token& stop) {
    const HostTime now = HostClock::now();
    std::array<std::uint8_t, kLargestFrame> chunk{};
    const auto count = ::read(terminal.master(), chunk.data(), chunk.size());
    if (count <= 0 || astray) return;
    if (input.empty()) arrival = now;
    input.insert(input.end(), chunk.begin(), chunk.begin() + count);
    // A client that did not wait for its answer sends frames without silence between them.
    while (!input.empty() && !astray) {
      const int length = rtu_frame_length(input);
      if (length < 0 || input.size() > kLargestFrame) {
        if (input.size() > kLargestFrame) lose_track();
        return;
      }
      if (length == 0 || input.size() < static_cast<std::size_t>(length)) return;
      const auto end = input.begin() + length;
      const ModbusBytes frame(input.begin(), end);
      input.erase(input.begin(), end);
      if (!take_frame(frame, stop)) lose_track();
      arrival = HostClock::now();
    }
  }

  /// What is not a frame is not looked at until the line falls silent.
  void lose_track() {
    input.clear();
    astray = true;
  }

  void end_by_silence(const std::stop_token& stop) {
    const ModbusBytes frame = std::move(input);
    input.clear();
    const bool whole = !astray && rtu_frame_length(frame) < 0;
    astray = false;
    if (whole) take_frame(frame, stop);
  }

  /// False if the checksum is wrong.
  bool take_frame(const ModbusBytes& frame, const std::stop_token& stop) {
    if (frame.size() < kSmallestFrame) return false;
    const auto body = std::span(frame).first(frame.size() - 2);
    const unsigned crc = modbus_crc(body);
    if (frame[body.size()] != (crc & 0xFFU) || frame[body.size() + 1] != crc >> 8U) return false;
    const bool broadcast = body[0] == 0;
    if (!broadcast && body[0] != options.unit) return true;
    ++requests;
    if (mute) return true;
    const HostTime start = std::max(arrival, bus_free);
    const LineAnswer answer = responder.answer(body.subspan(1));
    bus_free = start + characters(static_cast<double>(frame.size()));
    if (answer.cut) {
      stay_deaf(answer.outage, stop);
    } else if (!broadcast && !answer.pdu.empty()) {
      reply(answer, stop);
    }
    bus_free += options.timing.inter_frame;
    return true;
  }

  void reply(const LineAnswer& answer, const std::stop_token& stop) {
    ModbusBytes message{static_cast<std::uint8_t>(options.unit)};
    message.insert(message.end(), answer.pdu.begin(), answer.pdu.end());
    const unsigned crc = modbus_crc(message) ^ (answer.wrong_check ? 0x5555U : 0U);
    message.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
    message.push_back(static_cast<std::uint8_t>(crc >> 8U));
    if (answer.truncated) message.resize(message.size() / 2);
    bus_free += options.timing.turnaround + answer.late + characters(static_cast<double>(message.size()));
    wait_until(handed_over(bus_free), stop);
    [[maybe_unused]] const auto written = ::write(terminal.master(), message.data(), message.size());
  }

  /// The adapter's timer ticks freely: bytes wait for its next tick.
  [[nodiscard]] HostTime handed_over(HostTime at) const {
    const nanoseconds period = options.timing.usb_latency;
    if (period.count() == 0) return at;
    const nanoseconds since = at - born;
    return born + (since + period - nanoseconds(1)) / period * period;
  }

  void stay_deaf(std::chrono::milliseconds duration, const std::stop_token& stop) {
    const HostTime end = HostClock::now() + duration;
    wait_until(end, stop);
    input.clear();
    while (wait_readable(nanoseconds(0)) && !stop.stop_requested()) {
      std::array<std::uint8_t, kLargestFrame> chunk{};
      if (::read(terminal.master(), chunk.data(), chunk.size()) <= 0) return;
    }
  }

  const ModbusRtuOptions options;
  ScriptedResponder responder;  // server thread only
  PseudoTerminal terminal;
  FileDescriptor wake;
  const HostTime born = HostClock::now();
  ModbusBytes input;    // server thread only, as the next three
  HostTime arrival{};   // of the first byte of input
  HostTime bus_free{};  // when a request may begin
  bool astray = false;  // between garbage and the next silence
  std::atomic<std::uint64_t> requests{0};
  std::atomic<bool> mute{false};
  std::jthread thread;  // last
};

ModbusRtuServer::ModbusRtuServer(RegisterBank& bank, const ModbusRtuOptions& options)
    : impl_(std::make_unique<Impl>(bank, options)) {}
ModbusRtuServer::~ModbusRtuServer() = default;

const std::filesystem::path& ModbusRtuServer::path() const noexcept { return impl_->terminal.path(); }
std::uint64_t ModbusRtuServer::requests() const noexcept { return impl_->requests; }
void ModbusRtuServer::set_mute(bool mute) { impl_->mute = mute; }

}  // namespace fvd::sim
