#pragma once

/// A drive that answers as a test wants it to, request by request.

#include <functional>
#include <span>
#include <utility>

#include "sim/modbus/register_bank.hpp"

namespace fvd::test {

/// Asks before each write whether it is executed: kNone lets it through, anything else is the answer in its place. What
/// is read can be changed on its way. The functions are called on the line's thread.
class GatedBank final : public sim::RegisterBank {
 public:
  using Write = std::function<sim::ModbusException(int address, std::span<const std::uint16_t> values)>;
  using Read = std::function<sim::ModbusException(int address, std::span<std::uint16_t> values)>;

  /// before_write, after_read: may be empty.
  explicit GatedBank(sim::RegisterBank& drive, Write before_write, Read after_read = {})
      : drive_(drive), before_write_(std::move(before_write)), after_read_(std::move(after_read)) {}

  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    const auto exception = drive_.read(address, values);
    return exception == sim::ModbusException::kNone && after_read_ ? after_read_(address, values) : exception;
  }
  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    const auto exception = before_write_ ? before_write_(address, values) : sim::ModbusException::kNone;
    return exception == sim::ModbusException::kNone ? drive_.write(address, values) : exception;
  }
  void idle() override { drive_.idle(); }

 private:
  sim::RegisterBank& drive_;
  const Write before_write_;
  const Read after_read_;
};

/// "Later", and not executed.
inline constexpr auto kBusy = static_cast<sim::ModbusException>(6);
/// "Later", executed or about to be.
inline constexpr auto kAcknowledge = static_cast<sim::ModbusException>(5);

}  // namespace fvd::test
