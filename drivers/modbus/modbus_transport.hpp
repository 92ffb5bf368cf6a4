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
#include <string>
#include <variant>
#include <vector>

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
};

/// Throws Error kBadConfig naming what cannot be used and what can.
void check(const ModbusLinkConfig& config);

enum class ModbusTable { kHolding, kInput, kCoil, kDiscrete };

struct ModbusRequest {
  ModbusTable table = ModbusTable::kHolding;
  int address = 0;
  int read_count = 0;                  ///< > 0: a read
  std::vector<std::uint16_t> written;  ///< else a write; bits as 0 and 1
  bool single = false;                 ///< FC 5 or 6 instead of 15 or 16, for one value
};

/// context: one thread.
class ModbusTransport {
 public:
  /// Opens nothing yet. Throws Error kStageDisconnected if libmodbus takes no such endpoint.
  explicit ModbusTransport(const ModbusLinkConfig& config);
  ~ModbusTransport();
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;

  [[nodiscard]] bool connected() const noexcept { return connected_; }
  /// False with the reason in `error`. A serial port is taken exclusively, low latency is asked for, and what it was
  /// really set to is logged.
  bool connect(std::string& error);

  enum class Answer { kOk, kException, kNone };
  /// Sends one request and waits for its answer; fills `values` of a read. kNone: no usable answer, see `error`.
  Answer transact(const ModbusRequest& request, std::vector<std::uint16_t>& values, std::string& error);

  /// After kNone. RTU: reads and discards until silent or until hurry() says so. Returns the bytes discarded.
  std::size_t resynchronise(const std::function<bool()>& hurry);

  /// "host:port unit n" or "device unit n". context: any thread.
  [[nodiscard]] std::string description() const;

 private:
  struct ContextDeleter {
    void operator()(_modbus* context) const noexcept;
  };
  void close() noexcept;
  bool lock_serial_port(std::string& error);
  void unlock_serial_port() noexcept;
  void prepare_serial_port();
  int call(const ModbusRequest& request, std::vector<std::uint16_t>& values);

  ModbusLinkConfig config_;
  std::unique_ptr<_modbus, ContextDeleter> context_;
  bool connected_ = false;
  bool device_gone_ = false;
  int lock_ = -1;  // a descriptor of the serial port that holds its lock
  std::chrono::steady_clock::time_point last_byte_{};
};

}  // namespace fvd
