#pragma once

/// Registers and coils of a simulated device by PDU address (0-based).

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace fvd::sim {

/// Modbus exception codes (Modbus Application Protocol V1.1b3, section 7); kNone = no exception. The last three are of
/// Applied Motion's drives (920-0176 Rev A).
enum class ModbusException : std::uint8_t {
  kNone = 0,
  kIllegalFunction = 1,
  kIllegalAddress = 2,
  kIllegalValue = 3,
  kDeviceFailure = 4,
  kNotReadable = 0x11,
  kNotWritable = 0x12,
  kOutOfRange = 0x13,
};

/// The basic objects of a device's identification; each at most 80 characters.
struct DeviceIdentification {
  std::string vendor;
  std::string product;
  std::string revision;
};

/// A request either succeeds whole or changes nothing. context: one server's thread.
class RegisterBank {
 public:
  virtual ~RegisterBank() = default;

  /// address + values.size() <= 65536.
  [[nodiscard]] virtual ModbusException read(int address, std::span<std::uint16_t> values) = 0;
  [[nodiscard]] virtual ModbusException write(int address, std::span<const std::uint16_t> values) = 0;

  /// Coils, one byte each, 0 or 1. Devices without coils refuse every address.
  [[nodiscard]] virtual ModbusException read_bits(int /*address*/, std::span<std::uint8_t> /*bits*/) {
    return ModbusException::kIllegalAddress;
  }
  [[nodiscard]] virtual ModbusException write_bits(int /*address*/, std::span<const std::uint8_t> /*bits*/) {
    return ModbusException::kIllegalAddress;
  }

  /// Devices that cannot identify themselves have none.
  [[nodiscard]] virtual std::optional<DeviceIdentification> identification() const { return std::nullopt; }

  /// Called at least every kIdlePeriodMs while no request comes: for what a device does on its own, e.g. a watchdog.
  virtual void idle() {}
  static constexpr int kIdlePeriodMs = 20;
};

}  // namespace fvd::sim
