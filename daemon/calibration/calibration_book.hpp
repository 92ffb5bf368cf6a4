#pragma once

/// All versions of all constants: calibration.json in a folder, beside the reference maps that they name.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/result/calibration.hpp"

namespace fvd {

/// A file of a new version, written before the version is there.
struct CalibrationFile {
  std::string name;  ///< begins with the version's id, no path; "cal-0003-flatness.gsf"
  std::string bytes;
};

/// context: every function thread-safe; add() blocks for files, those that only read never wait for it.
class CalibrationBook {
 public:
  /// Reads <folder>/calibration.json; no such file = no versions yet. Throws Error kBadInput with the place of what is
  /// wrong: constants that cannot be read must not be taken for none.
  explicit CalibrationBook(std::filesystem::path folder);

  /// The newest version for this objective ("" = no objective is named).
  [[nodiscard]] std::optional<Calibration> current(const std::string& objective) const;
  [[nodiscard]] std::optional<Calibration> find(const std::string& id) const;
  [[nodiscard]] std::vector<Calibration> versions() const;

  /// A new version: the objective's newest with `change` done to it, under a new id and with the time it is made. The
  /// id is known to `change`, which returns the files that it names and does not call the book. Durable at the return:
  /// files first, then calibration.json, replaced as a whole. Throws Error kStorageFull, kStorageWrite, and kBadInput
  /// where a constant is out of its range; nothing has changed then, but where the last flush failed: the version is
  /// there then, though a power cut may take it away.
  Calibration add(const std::string& objective,
                  const std::function<std::vector<CalibrationFile>(Calibration& next)>& change);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::optional<Calibration> newest(const std::string& objective) const FVD_REQUIRES(mutex_);
  void keep(const Calibration& next);

  std::filesystem::path folder_;
  Mutex adding_;  ///< held while files are written; before mutex_
  mutable Mutex mutex_;
  std::vector<Calibration> versions_ FVD_GUARDED_BY(mutex_);
};

}  // namespace fvd
