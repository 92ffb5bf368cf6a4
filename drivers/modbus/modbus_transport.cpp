#include "drivers/modbus/modbus_transport.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <linux/serial.h>
#include <modbus/modbus.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

using SteadyClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Silence between two frames: 3.5 characters, and a fixed time above 19200 baud (MODBUS over Serial Line
/// V1.02, 2.5.1.1).
std::chrono::microseconds frame_gap(const ModbusSerialEndpoint& line) {
  constexpr std::int64_t kBitsPerCharacter = 11;
  if (line.baud > 19200) return std::chrono::microseconds(1750);
  return std::chrono::microseconds(35 * kBitsPerCharacter * 100000 / line.baud);
}

/// How often a drain looks whether somebody is in a hurry.
constexpr milliseconds kDrainSlice{5};
/// A line that never falls silent is drained for so many quiet times at most.
constexpr int kMostQuietTimes = 8;

/// Header of Modbus TCP: transaction, protocol, length, unit.
constexpr std::size_t kTcpHeader = 7;
constexpr std::size_t kUnitInTcpHeader = 6;
/// A connection that ends this soon after an answer was ended because of it.
constexpr std::chrono::seconds kSoonAfterAnswer{1};

/// A connection that brings more of what nobody asked for is replaced.
constexpr std::size_t kMostUnasked = 64 * std::size_t{1024};

bool is_device_gone(int error) { return error == EIO || error == ENXIO || error == ENODEV || error == EBADF; }

/// The latency timer of an FTDI adapter in ms, which holds short replies back; asks for 1. Empty for other ports.
std::string ftdi_latency(const std::string& device) {
  std::array<char, PATH_MAX> real{};
  if (::realpath(device.c_str(), real.data()) == nullptr) return "";
  const std::string name = std::string(real.data()).substr(std::string(real.data()).rfind('/') + 1);
  const std::string file = "/sys/class/tty/" + name + "/device/latency_timer";
  std::ofstream(file) << "1\n";
  std::ifstream in(file);
  std::string value;
  return std::getline(in, value) ? ", USB latency timer " + value + " ms" : "";
}

/// libmodbus tells a name that nobody knows as a refused connection.
void explain_name(const std::string& host, std::string& error) {
  addrinfo* found = nullptr;
  const int unknown = ::getaddrinfo(host.c_str(), nullptr, nullptr, &found);
  if (found != nullptr) ::freeaddrinfo(found);
  if (unknown != 0) error = "no host is called '" + host + "': " + ::gai_strerror(unknown);
}

}  // namespace

void ModbusTransport::ContextDeleter::operator()(modbus_t* context) const noexcept {
  modbus_close(context);
  modbus_free(context);
}

void check(const ModbusLinkConfig& config) {
  std::ostringstream problem;
  if (config.unit < 1 || config.unit > 247) problem << "unit " << config.unit << ": expected 1..247";
  if (const auto* line = std::get_if<ModbusSerialEndpoint>(&config.endpoint)) {
    if (std::find(std::begin(kModbusBauds), std::end(kModbusBauds), line->baud) == std::end(kModbusBauds)) {
      problem << "a baud rate of " << line->baud << ": expected one of";
      for (const int baud : kModbusBauds) problem << ' ' << baud;
    } else if (line->parity != 'N' && line->parity != 'E' && line->parity != 'O') {
      problem << "parity " << line->parity << ": expected N, E or O";
    } else if (line->stop_bits != 1 && line->stop_bits != 2) {
      problem << line->stop_bits << " stop bits: expected 1 or 2";
    }
  }
  if (!problem.str().empty()) throw Error(ErrorCode::kBadConfig, problem.str());
}

ModbusTransport::ModbusTransport(const ModbusLinkConfig& config) : config_(config) {
  check(config_);
  if (const auto* tcp = std::get_if<ModbusTcpEndpoint>(&config_.endpoint)) {
    context_.reset(modbus_new_tcp_pi(tcp->host.c_str(), std::to_string(tcp->port).c_str()));
  } else {
    const auto& line = std::get<ModbusSerialEndpoint>(config_.endpoint);
    context_.reset(modbus_new_rtu(line.device.c_str(), line.baud, line.parity, 8, line.stop_bits));
  }
  if (!context_) {
    throw Error(ErrorCode::kStageDisconnected,
                "no Modbus connection to " + description() + ": " + modbus_strerror(errno));
  }
  modbus_set_error_recovery(context_.get(), MODBUS_ERROR_RECOVERY_NONE);
  // A tenth is left for the urgent request that waits behind this one: it is to be through within the whole.
  const auto timeout = std::chrono::duration_cast<std::chrono::microseconds>(config_.response_timeout).count() * 9 / 10;
  modbus_set_response_timeout(context_.get(), static_cast<std::uint32_t>(timeout / 1000000),
                              static_cast<std::uint32_t>(timeout % 1000000));
  // 0 = the whole reply within the response timeout: a trickle of bytes cannot stretch it.
  modbus_set_byte_timeout(context_.get(), 0, 0);
  modbus_set_slave(context_.get(), config_.unit);
}

ModbusTransport::~ModbusTransport() { unlock_serial_port(); }

void ModbusTransport::close() noexcept {
  modbus_close(context_.get());
  unlock_serial_port();
  connected_ = false;
}

bool ModbusTransport::connect(std::string& error) {
  if (!is_tcp() && !lock_serial_port(error)) return false;
  if (modbus_connect(context_.get()) != 0) {
    const int code = errno;
    error = modbus_strerror(code);
    if (code == EINPROGRESS || code == ETIMEDOUT) {
      error = "nobody answered the connection within " + std::to_string(config_.response_timeout.count() * 9 / 10) +
              " ms, or a firewall drops it";
    } else if (code == ECONNREFUSED && is_tcp()) {
      explain_name(std::get<ModbusTcpEndpoint>(config_.endpoint).host, error);
    }
    unlock_serial_port();
    return false;
  }
  connected_ = true;
  device_gone_ = answered_ = false;
  if (!is_tcp()) {
    prepare_serial_port();
  } else {
    const int on = 1;
    ::setsockopt(modbus_get_socket(context_.get()), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  }
  return true;
}

bool ModbusTransport::ensure_connected(bool writes, bool& renewed, std::string& error) {
  renewed = false;
  if (connected_ && is_tcp()) {
    discard_unasked();
    if (writes && answered_ && closes_after_answer_) close();
  }
  if (connected_) return true;
  renewed = true;
  return connect(error);
}

/// What came in the meantime answers nothing that is going to be asked. An end of the connection is no doubt: whatever
/// was asked was answered.
void ModbusTransport::discard_unasked() {
  std::array<std::uint8_t, 256> chunk{};
  for (std::size_t discarded = 0;;) {
    const auto count = ::recv(modbus_get_socket(context_.get()), chunk.data(), chunk.size(), MSG_DONTWAIT);
    if (count > 0) {
      discarded_ += static_cast<std::size_t>(count);
      discarded += static_cast<std::size_t>(count);
      if (discarded > kMostUnasked) return close();
      continue;
    }
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    closes_after_answer_ = answered_ && SteadyClock::now() - last_byte_ < kSoonAfterAnswer;
    return close();
  }
}

/// Before the port is touched: who opens it to set it up disturbs the one that uses it.
bool ModbusTransport::lock_serial_port(std::string& error) {
  const auto& line = std::get<ModbusSerialEndpoint>(config_.endpoint);
  lock_ = ::open(line.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (lock_ < 0 && errno != EBUSY) {
    error = std::strerror(errno);
    return false;
  }
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) return true;
  unlock_serial_port();
  error = "it is in use by another program";
  return false;
}

void ModbusTransport::unlock_serial_port() noexcept {
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
}

void ModbusTransport::prepare_serial_port() {
  const auto& line = std::get<ModbusSerialEndpoint>(config_.endpoint);
  const int fd = modbus_get_socket(context_.get());
  // The lock keeps well-behaved programs out, exclusive use all but root's.
  const bool exclusive = ::ioctl(fd, TIOCEXCL) == 0;
  serial_struct settings{};
  bool low_latency = false;
  if (::ioctl(fd, TIOCGSERIAL, &settings) == 0) {
    settings.flags |= ASYNC_LOW_LATENCY;
    low_latency = ::ioctl(fd, TIOCSSERIAL, &settings) == 0;
  }
  spdlog::info("{}: {} baud 8{}{}{}{}{}", line.device, line.baud, line.parity, line.stop_bits,
               exclusive ? ", exclusive" : ", not exclusive",
               low_latency ? ", low latency" : ", low latency not available", ftdi_latency(line.device));
  ::tcflush(fd, TCIOFLUSH);
}

/// False on a serial line with bytes that nobody asked for: they must not be taken for the answer to what follows.
bool ModbusTransport::wait_for_line(std::string& error) {
  const auto* line = std::get_if<ModbusSerialEndpoint>(&config_.endpoint);
  if (line == nullptr) return true;
  std::this_thread::sleep_until(last_byte_ + frame_gap(*line));
  int waiting = 0;
  if (::ioctl(modbus_get_socket(context_.get()), FIONREAD, &waiting) != 0 || waiting == 0) return true;
  error = "bytes nobody asked for on the line";
  return false;
}

/// libmodbus would give every raw request the same transaction number, and late answers could not be told apart.
bool ModbusTransport::send(Bytes pdu) {
  std::vector<std::uint8_t> frame;
  if (is_tcp()) {
    ++transaction_;
    const std::size_t length = pdu.size() + 1;
    for (const std::size_t word : {std::size_t{transaction_}, std::size_t{0}, length}) {
      frame.push_back(static_cast<std::uint8_t>(word >> 8U & 0xFFU));
      frame.push_back(static_cast<std::uint8_t>(word & 0xFFU));
    }
  }
  frame.push_back(static_cast<std::uint8_t>(config_.unit));
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  if (is_tcp()) {
    const auto sent = ::send(modbus_get_socket(context_.get()), frame.data(), frame.size(), MSG_NOSIGNAL);
    return sent == static_cast<ssize_t>(frame.size());
  }
  return modbus_send_raw_request(context_.get(), frame.data(), static_cast<int>(frame.size())) != -1;
}

/// Why what came is no answer to what was sent; empty if it may be one. count: of libmodbus, -1 with its error `code`.
/// frame: what came as far as it is known, zeros behind it.
std::string ModbusTransport::doubt(Bytes frame, int count, Bytes sent, int code) const {
  const std::size_t unit_at = is_tcp() ? kUnitInTcpHeader : 0;
  const auto other_unit = [&] {
    return "an answer of unit " + std::to_string(frame[unit_at]) + " to a question to unit " +
           std::to_string(config_.unit) + ": do two devices share an address, or is a gateway's table wrong?";
  };
  if (!is_tcp()) {
    if (count == 0) return other_unit();  // libmodbus looks at nothing else of such a frame
    // The answer to a read repeats neither address nor count of the question.
    constexpr std::uint8_t kLastRead = 4;
    const bool echoes = sent[0] <= kLastRead && frame[0] == config_.unit &&
                        std::equal(sent.begin(), sent.begin() + 4, frame.begin() + 1);
    // Taken for an answer, its address tells the length: with a large one more is waited for.
    if (count < 0 && (code == EMBBADCRC || code == ETIMEDOUT) && echoes) {
      return "the line returns what is sent: switch off the local echo of the two-wire adapter";
    }
  }
  if (count < 0 && code == ETIMEDOUT) return "no answer in time";
  if (count < 0) return modbus_strerror(code);
  if (static_cast<std::size_t>(count) <= unit_at + 1) return "an answer of another length";
  if (!is_tcp()) return frame[0] == config_.unit ? "" : other_unit();
  if (frame[2] != 0 || frame[3] != 0) return "an answer of another protocol than Modbus TCP";
  if (frame[0] != transaction_ >> 8U || frame[1] != (transaction_ & 0xFFU)) return "an answer to another question";
  return frame[unit_at] == config_.unit ? "" : other_unit();
}

PduAnswer ModbusTransport::transact(const ModbusRequest& request, std::vector<std::uint16_t>& values,
                                    std::string& error) {
  values.clear();
  if (!wait_for_line(error)) return PduAnswer::kNone;
  const std::vector<std::uint8_t> pdu = request_pdu(request);
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> frame{};
  const int count = send(pdu) ? modbus_receive_confirmation(context_.get(), frame.data()) : -1;
  const int code = errno;
  last_byte_ = SteadyClock::now();
  error = doubt(frame, count, pdu, code);
  if (!error.empty()) {
    device_gone_ = count == -1 && is_device_gone(code);
    if (count == -1 && code == ECONNRESET && answered_) closes_after_answer_ = true;
    return PduAnswer::kNone;
  }
  if (std::exchange(answered_, true)) closes_after_answer_ = false;
  const std::size_t before = is_tcp() ? kTcpHeader : 1;
  const std::size_t behind = is_tcp() ? 0 : 2;  // the checksum
  const auto length = static_cast<std::size_t>(count);
  if (length < before + behind) {
    error = "an answer of another length";
    return PduAnswer::kNone;
  }
  return judge_answer(request, pdu, Bytes(frame).subspan(before, length - before - behind), values, error);
}

void ModbusTransport::resynchronise(const std::function<bool()>& hurry) {
  if (!connected_) return;
  if (is_tcp() || device_gone_) return close();
  const int fd = modbus_get_socket(context_.get());
  const auto begin = SteadyClock::now();
  auto silent_since = begin;
  while (SteadyClock::now() - silent_since < config_.quiet &&
         SteadyClock::now() - begin < kMostQuietTimes * config_.quiet && !hurry()) {
    pollfd waiting{fd, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(kDrainSlice.count())) <= 0) continue;
    std::array<std::uint8_t, 256> chunk{};
    const auto count = ::read(fd, chunk.data(), chunk.size());
    if (count > 0) {
      discarded_ += static_cast<std::size_t>(count);
      silent_since = SteadyClock::now();
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      return close();  // the adapter was unplugged
    }
  }
  ::tcflush(fd, TCIFLUSH);
}

std::string ModbusTransport::description() const {
  const std::string unit = " unit " + std::to_string(config_.unit);
  if (const auto* tcp = std::get_if<ModbusTcpEndpoint>(&config_.endpoint)) {
    return tcp->host + ":" + std::to_string(tcp->port) + unit;
  }
  return std::get<ModbusSerialEndpoint>(config_.endpoint).device + unit;
}

}  // namespace fvd
