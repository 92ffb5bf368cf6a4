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

/// The drive says that it did not execute the request. It does not say so where it is still at it, or busy, nor where a
/// gateway had no answer from it.
bool is_exception(int error) {
  if (error == EMBXACK || error == EMBXSBUSY || error == EMBXGTAR) return false;
  return (error > MODBUS_ENOBASE && error < EMBXGTAR) || error == EMBBADEXC;
}

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
  const bool serial = std::holds_alternative<ModbusSerialEndpoint>(config_.endpoint);
  if (serial && !lock_serial_port(error)) return false;
  if (modbus_connect(context_.get()) != 0) {
    error = modbus_strerror(errno);
    unlock_serial_port();
    return false;
  }
  connected_ = true;
  device_gone_ = false;
  if (serial) {
    prepare_serial_port();
  } else {
    const int on = 1;
    ::setsockopt(modbus_get_socket(context_.get()), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  }
  return true;
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

int ModbusTransport::call(const ModbusRequest& request, std::vector<std::uint16_t>& values) {
  const bool bits = request.table == ModbusTable::kCoil || request.table == ModbusTable::kDiscrete;
  modbus_t* const context = context_.get();
  if (request.read_count > 0) {
    values.resize(static_cast<std::size_t>(request.read_count));
    if (!bits) {
      return request.table == ModbusTable::kInput
                 ? modbus_read_input_registers(context, request.address, request.read_count, values.data())
                 : modbus_read_registers(context, request.address, request.read_count, values.data());
    }
    std::vector<std::uint8_t> read(values.size());
    const int count = request.table == ModbusTable::kDiscrete
                          ? modbus_read_input_bits(context, request.address, request.read_count, read.data())
                          : modbus_read_bits(context, request.address, request.read_count, read.data());
    std::copy(read.begin(), read.end(), values.begin());
    return count;
  }
  const auto count = static_cast<int>(request.written.size());
  const bool single = request.single && count == 1;
  if (!bits) {
    return single ? modbus_write_register(context, request.address, request.written[0])
                  : modbus_write_registers(context, request.address, count, request.written.data());
  }
  if (single) return modbus_write_bit(context, request.address, request.written[0]);
  const std::vector<std::uint8_t> written(request.written.begin(), request.written.end());
  return modbus_write_bits(context, request.address, count, written.data());
}

ModbusTransport::Answer ModbusTransport::transact(const ModbusRequest& request, std::vector<std::uint16_t>& values,
                                                  std::string& error) {
  if (const auto* line = std::get_if<ModbusSerialEndpoint>(&config_.endpoint)) {
    std::this_thread::sleep_until(last_byte_ + frame_gap(*line));
    // What came in the meantime answers nothing that was asked: it must not be taken for the answer to this.
    int waiting = 0;
    if (::ioctl(modbus_get_socket(context_.get()), FIONREAD, &waiting) == 0 && waiting > 0) {
      error = "bytes nobody asked for on the line";
      return Answer::kNone;
    }
  }
  const int count = call(request, values);
  const int code = errno;
  last_byte_ = SteadyClock::now();
  const int expected = request.read_count > 0 ? request.read_count : static_cast<int>(request.written.size());
  if (count == expected) return Answer::kOk;
  values.clear();
  error = count == -1 ? modbus_strerror(code) : "an answer of another length";
  if (count == -1 && is_exception(code)) return Answer::kException;
  device_gone_ = count == -1 && is_device_gone(code);
  return Answer::kNone;
}

std::size_t ModbusTransport::resynchronise(const std::function<bool()>& hurry) {
  if (!connected_) return 0;
  if (std::holds_alternative<ModbusTcpEndpoint>(config_.endpoint) || device_gone_) {
    close();
    return 0;
  }
  const int fd = modbus_get_socket(context_.get());
  std::size_t discarded = 0;
  const auto begin = SteadyClock::now();
  auto silent_since = begin;
  while (SteadyClock::now() - silent_since < config_.quiet &&
         SteadyClock::now() - begin < kMostQuietTimes * config_.quiet && !hurry()) {
    pollfd waiting{fd, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(kDrainSlice.count())) <= 0) continue;
    std::array<std::uint8_t, 256> chunk{};
    const auto count = ::read(fd, chunk.data(), chunk.size());
    if (count > 0) {
      discarded += static_cast<std::size_t>(count);
      silent_since = SteadyClock::now();
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      close();  // the adapter was unplugged
      return discarded;
    }
  }
  ::tcflush(fd, TCIFLUSH);
  return discarded;
}

std::string ModbusTransport::description() const {
  const std::string unit = " unit " + std::to_string(config_.unit);
  if (const auto* tcp = std::get_if<ModbusTcpEndpoint>(&config_.endpoint)) {
    return tcp->host + ":" + std::to_string(tcp->port) + unit;
  }
  return std::get<ModbusSerialEndpoint>(config_.endpoint).device + unit;
}

}  // namespace fvd
