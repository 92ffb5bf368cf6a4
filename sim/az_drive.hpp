#pragma once

/// The registers of an Oriental Motor AZ drive (HM-60262-6E; addresses are PDU addresses, 32-bit values high word
/// first) on top of a simulated axis.

#include <array>
#include <atomic>
#include <cstdint>

#include "sim/axis_model.hpp"
#include "sim/register_bank.hpp"

namespace fvd::sim {

/// | 0x0058..0x0069 | direct data operation: number, type, position, speed, rates, current, trigger, destination |
/// | 0x0078/79      | driver input, automatic OFF: bit 4 HOME, 5 STOP, 7 ALM-RST                                 |
/// | 0x007C/7D      | driver input, level: the same bits, bit 6 FREE                                             |
/// | 0x007E/7F      | driver output: bit 4 HOME-END, 5 READY, 7 ALM-A, 8 SYS-BSY, 13 MOVE, 14 IN-POS               |
/// | 0x0080/81      | present alarm; 0x0180/81 <- 1 resets it                                                    |
/// | 0x00C6, 0x0122 | command position; 0x00CC, 0x0120 actual (encoder) position, steps                          |
/// | 0x00F8, 0x00FA | driver and motor temperature, 0.1 degC                                                     |
/// | 0x0178..0x017F | output image independent of the assignment of signals                                      |
/// | 0x018A         | position preset; 0x0386, 0x0388, 0x038A software overtravel: action, + and - limit         |
///
/// Other addresses below 0x0400 read as 0 and keep what is written, above are refused. A move is ignored without a word
/// when the drive is not READY, as the real one does.
class AzDrive final : public RegisterBank {
 public:
  /// axis outlives the drive.
  explicit AzDrive(AxisModel& axis);

  [[nodiscard]] ModbusException read(int address, std::span<std::uint16_t> values) override;
  [[nodiscard]] ModbusException write(int address, std::span<const std::uint16_t> values) override;

  // context: any thread.
  void raise_alarm(int code);                                  ///< stops the axis, as the real drive does
  void refuse_moves(int count);                                ///< the next `count` moves are ignored without a word
  [[nodiscard]] int moves() const noexcept { return moves_; }  ///< moves executed since power on

 private:
  static constexpr int kRegisters = 0x0400;

  [[nodiscard]] std::int32_t long_at(int address) const;
  void set_long(int address, std::int32_t value);
  void refresh(HostTime now);
  void written(int address, std::size_t count, HostTime now);
  void act_on_inputs(unsigned rising, HostTime now);
  void start_direct_operation(HostTime now);
  [[nodiscard]] bool ready(HostTime now) const;
  [[nodiscard]] bool leaves_limits(std::int32_t target, HostTime now) const;

  AxisModel& axis_;
  std::array<std::uint16_t, kRegisters> registers_{};
  std::atomic<int> alarm_{0};
  std::atomic<int> refused_moves_{0};
  std::atomic<int> moves_{0};
};

}  // namespace fvd::sim
