#pragma once

/// Tells registers that somebody else wrote from those that fvd did: a second master on the drive.

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "drivers/common/axis_port.hpp"
#include "drivers/modbus/drive_register.hpp"

namespace fvd {

/// Remembers what fvd wrote to the watched registers; a write without an answer leaves two values that may stand there.
/// context: thread-safe.
class OwnWrites {
 public:
  explicit OwnWrites(std::vector<DriveRegister> watched);

  /// As ModbusLink::observe_writes() wants it.
  void saw(const ModbusRequest& write, bool sent, bool done);

  /// Reads the watched registers. What of them fvd did not write, once per value; nothing at the first look, while a
  /// write is on its way, and unless all can be read. Where all that fvd knows of became 0 at once, the drive was
  /// restarted. A stop request ends the patience with a busy drive.
  [[nodiscard]] std::optional<ForeignWrite> foreign(ModbusLink& link, const std::stop_token& stop);

 private:
  /// Values of which one stands in a register; empty = not known yet.
  using Possible = std::vector<std::int64_t>;

  [[nodiscard]] std::optional<std::uint64_t> quiet_epoch() const;
  [[nodiscard]] std::optional<ForeignWrite> judge(const std::vector<std::int64_t>& values) FVD_REQUIRES(mutex_);

  const std::vector<DriveRegister> registers_;
  mutable Mutex mutex_;
  std::vector<Possible> possible_ FVD_GUARDED_BY(mutex_);  // of each register
  int on_their_way_ FVD_GUARDED_BY(mutex_) = 0;
  std::uint64_t epoch_ FVD_GUARDED_BY(mutex_) = 0;  // of writes
};

}  // namespace fvd
