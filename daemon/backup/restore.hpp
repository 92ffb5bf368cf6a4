#pragma once

/// Puts a backup back.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/backup/backup.hpp"

namespace fvd {

struct Restored {
  std::int64_t epoch = 0;                        ///< the next start has a higher one
  std::filesystem::path replaced;                ///< where what was there before is now; empty = there was nothing
  std::vector<std::filesystem::path> dropped{};  ///< what earlier restorations replaced: the two newest are kept
  /// So many numbers above the newest known may have been used since the backup; 0 = what was there before told all.
  std::int64_t margin = 0;
  int results = 0;                     ///< that were added
  std::vector<std::string> unknown{};  ///< folders of results and evaluations that the backup does not know; they stay
  std::vector<std::string> kept{};     ///< what was there and was left as it is
};

/// The daemon must not run. Database, edited recipes, calibration, studies and history take the place of those that are
/// there, which are moved aside; results are added; the configuration and the shipped recipes are put back only where
/// there are none. Interrupted, it may be repeated. Throws Error kBadInput for a folder that is no backup, kDatabase
/// where a daemon runs, kStorageFull, kStorageWrite.
Restored restore_backup(const std::filesystem::path& folder, const InstrumentPaths& instrument);

/// True of a folder that a restoration began to fill and did not finish.
[[nodiscard]] bool is_half_restored(const std::filesystem::path& folder);

}  // namespace fvd
