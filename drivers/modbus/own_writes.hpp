#pragma once

/// Tells registers that somebody else wrote from those that fvd did: a second master on the drive.

#include <cstdint>
#include <optional>
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
  /// restart_reads_zero: a watched register that reads 0 tells of a restart, which the drive does not tell otherwise.
  OwnWrites(std::vector<DriveRegister> watched, bool restart_reads_zero);

  /// As ModbusLink::observe_writes() wants it.
  void saw(const ModbusRequest& write, bool sent, bool done);

  /// Reads the watched registers. What of them fvd did not write, once per value; nothing at the first look, while a
  /// write is on its way, and where a register cannot be read.
  [[nodiscard]] std::optional<ForeignWrite> foreign(ModbusLink& link);

 private:
  struct Watched {
    DriveRegister reg;
    std::vector<std::int64_t> possible;  ///< values of which one stands there; empty = not known yet
  };

  [[nodiscard]] std::optional<std::uint64_t> quiet_epoch() const;
  [[nodiscard]] std::optional<ForeignWrite> judge(Watched& watched, std::int64_t value) const FVD_REQUIRES(mutex_);

  const bool restart_reads_zero_;
  const std::vector<DriveRegister> registers_;
  mutable Mutex mutex_;
  std::vector<Watched> watched_ FVD_GUARDED_BY(mutex_);
  int on_their_way_ FVD_GUARDED_BY(mutex_) = 0;
  std::uint64_t epoch_ FVD_GUARDED_BY(mutex_) = 0;  // of writes
};

}  // namespace fvd
