#pragma once

/// One libmodbus context, TCP or RTU, and how it is put right after a doubt. `modbus.h` is included by its .cpp alone.
///
/// libmodbus' own error recovery stays off: it repeats writes and cannot be interrupted. After any answer that is not
/// clean, resynchronise() makes sure that no late reply can meet the next request: on TCP by a new socket, on RTU by
/// reading until the line is silent. RTU frames carry no transaction number, so a late reply that is taken for the next
/// one's is a wrong value nobody can tell from a right one.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "drivers/modbus/modbus_pdu.hpp"

struct _modbus;  // libmodbus' modbus_t. NOLINT(bugprone-reserved-identifier): its name

namespace fvd {

struct ModbusTcpEndpoint {
  std::string host = "127.0.0.1";
  int port = 502;
};

struct ModbusSerialEndpoint {
  std::string device;  ///< best a name below /dev/serial/by-id: numbers change with the order of plugging
  int baud = 115200;   ///< one of kModbusBauds
  char parity = 'E';   ///< 'N', 'E' or 'O'
  int stop_bits = 1;   ///< 1 or 2
};

/// What the serial line may be set to; libmodbus would silently make 9600 of anything it does not know.
inline constexpr int kModbusBauds[] = {9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600};

struct ModbusLinkConfig {
  std::variant<ModbusTcpEndpoint, ModbusSerialEndpoint> endpoint = ModbusTcpEndpoint{};
  int unit = 1;  ///< 1..247
  /// An urgent request is through within it. A reply, and a TCP connection to be made, may take nine tenths.
  std::chrono::milliseconds response_timeout{200};
  /// RTU: how long the line must be silent before a request may follow a doubtful answer; at least the slowest reply.
  std::chrono::milliseconds quiet{250};
  /// How long a request that does no harm twice is repeated while the device says "later".
  std::chrono::milliseconds patience{2000};
};

/// Throws Error kBadConfig naming what cannot be used and what can.
void check(const ModbusLinkConfig& config);

/// context: one thread.
class ModbusTransport {
 public:
  /// Opens nothing yet. Throws Error kStageDisconnected if libmodbus takes no such endpoint.
  explicit ModbusTransport(const ModbusLinkConfig& config);
  ~ModbusTransport();
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;

  /// Before every request. Connects where there is no connection, or where the other side has ended it: gateways do so
  /// after a time, some after every answer. Bytes that nobody asked for are discarded on TCP. A serial port is taken
  /// exclusively, low latency is asked for, and what it was really set to is logged. False with the reason in `error`:
  /// nothing can be sent. renewed: a connection was made. writes: what follows must not be lost in a dying connection.
  bool ensure_connected(bool writes, bool& renewed, std::string& error);

  /// Sends one request and waits for its answer; fills `values` of a read. kNone: no usable answer, see `error`, which
  /// names what the bytes show: another unit's answer, another protocol, the line's own echo.
  PduAnswer transact(const ModbusRequest& request, std::vector<std::uint16_t>& values, std::string& error);

  /// After kNone. RTU: reads and discards until silent or until hurry() says so.
  void resynchronise(const std::function<bool()>& hurry);

  /// Bytes that were discarded since the last call, late, garbled or unasked for.
  [[nodiscard]] std::size_t take_discarded() noexcept { return std::exchange(discarded_, 0); }

  /// context: any thread, as description().
  [[nodiscard]] bool is_tcp() const noexcept { return std::holds_alternative<ModbusTcpEndpoint>(config_.endpoint); }
  /// "host:port unit n" or "device unit n".
  [[nodiscard]] std::string description() const;

 private:
  struct ContextDeleter {
    void operator()(_modbus* context) const noexcept;
  };
  using Bytes = std::span<const std::uint8_t>;

  void close() noexcept;
  bool connect(std::string& error);
  void discard_unasked();
  bool lock_serial_port(std::string& error);
  void unlock_serial_port() noexcept;
  void prepare_serial_port();
  bool wait_for_line(std::string& error);
  bool send(Bytes pdu);
  [[nodiscard]] std::string doubt(Bytes frame, int count, Bytes sent, int code) const;

  ModbusLinkConfig config_;
  std::unique_ptr<_modbus, ContextDeleter> context_;
  bool connected_ = false;
  bool device_gone_ = false;
  bool answered_ = false;             // something came on this connection
  bool closes_after_answer_ = false;  // the other side was seen to
  std::uint16_t transaction_ = 0;     // TCP: the last one's number
  std::size_t discarded_ = 0;
  int lock_ = -1;  // a descriptor of the serial port that holds its lock
  std::chrono::steady_clock::time_point last_byte_{};
};

}  // namespace fvd
