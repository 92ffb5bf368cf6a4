#pragma once

/// One master per drive: a lock file that whoever opens a drive takes first. Who does not get it writes nothing.

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/common/driver_config.hpp"

namespace fvd {

/// The folder of all processes of this machine: it depends on the machine and not on who asks, but for one without
/// /run/lock, where it is in /tmp and the log warns.
[[nodiscard]] std::filesystem::path drive_lock_folder();

/// Name of the drive's lock file: of its serial port by its real path, or of its address, port and unit (GCS: axis).
/// Throws Error kStageDisconnected for a host without an address.
[[nodiscard]] std::string drive_lock_name(const StageConfig& config);

/// Holds the lock of a drive for as long as it lives; the system frees that of a process that dies.
/// context: any thread; two objects exclude each other within a process too.
class DriveLock {
 public:
  /// Throws Error kStageTaken naming process and program that hold the lock, kBadConfig if there can be no lock file,
  /// and as drive_lock_name() does. Waits for no holder, only for the
  /// address of a host that is named.
  explicit DriveLock(const StageConfig& config);
  ~DriveLock();
  DriveLock(const DriveLock&) = delete;
  DriveLock& operator=(const DriveLock&) = delete;

 private:
  [[noreturn]] void refuse_file() const;
  [[noreturn]] void refuse_drive(int failure) const;

  std::filesystem::path path_;
  int file_ = -1;
};

/// The lock that the configuration brings, else one that is taken now; throws as DriveLock does.
[[nodiscard]] std::shared_ptr<const DriveLock> drive_lock_of(const StageConfig& config);

}  // namespace fvd
