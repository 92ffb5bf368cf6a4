#pragma once

/// A drive behind a slow gateway: some requests are put off, and of those some are executed all the same.

#include <array>
#include <atomic>
#include <cstdint>
#include <random>
#include <span>

#include "sim/modbus/register_bank.hpp"

namespace fvd::test {

/// Puts off a share of all reads and writes with the exceptions 5, 6, 0x0A and 0x0B. What may be executed and answered
/// so - 5 says so, 0x0B leaves it open - is executed every second time.
class BusyBank final : public sim::RegisterBank {
 public:
  BusyBank(sim::RegisterBank& drive, double share, unsigned seed) : drive_(drive), random_(seed), busy_(share) {}

  sim::ModbusException read(int address, std::span<std::uint16_t> values) override {
    return is_put_off() ? next_exception() : drive_.read(address, values);
  }

  sim::ModbusException write(int address, std::span<const std::uint16_t> values) override {
    if (!is_put_off()) return drive_.write(address, values);
    const sim::ModbusException exception = next_exception();
    const bool is_open = exception == kAcknowledge || exception == kGatewayTarget;
    if (is_open && (executed_ = !executed_)) (void)drive_.write(address, values);
    return exception;
  }

  void idle() override { drive_.idle(); }
  [[nodiscard]] int put_off() const noexcept { return put_off_; }

 private:
  static constexpr auto kAcknowledge = static_cast<sim::ModbusException>(5);
  static constexpr auto kBusy = static_cast<sim::ModbusException>(6);
  static constexpr auto kGatewayPath = static_cast<sim::ModbusException>(10);
  static constexpr auto kGatewayTarget = static_cast<sim::ModbusException>(11);

  bool is_put_off() {
    if (!busy_(random_)) return false;
    ++put_off_;
    return true;
  }
  sim::ModbusException next_exception() {
    constexpr std::array kAll{kAcknowledge, kBusy, kGatewayPath, kGatewayTarget};
    return kAll[next_++ % kAll.size()];
  }

  sim::RegisterBank& drive_;
  std::mt19937 random_;  // one server's thread, as all below
  std::bernoulli_distribution busy_;
  std::size_t next_ = 0;
  bool executed_ = false;
  std::atomic<int> put_off_{0};
};

}  // namespace fvd::test
