#include "daemon/backup/backup.hpp"

#include <cerrno>
#include <system_error>

#include "core/base/error.hpp"
#include "daemon/backup/copied_files.hpp"
#include "daemon/backup/state_files.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/store/database_copy.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> results_in(const fs::path& database_file) {
  const Database database(database_file);
  Statement rows(database,
                 "SELECT result_dir FROM jobs WHERE result_dir <> '' AND removed_utc = '' "
                 "UNION ALL SELECT result_dir FROM evaluations");
  std::vector<std::string> names;
  while (rows.step()) names.push_back(fs::path(rows.text(0)).filename().string());
  return names;
}

/// False where it is not there, or goes meanwhile: the daemon may remove results, or their slices, to make room.
bool copy_result(const fs::path& from, const fs::path& to) {
  for (bool again = false;; again = true) {
    std::error_code error;
    if (!fs::is_directory(from, error)) return false;
    try {
      copy_durably(from, to);
      return true;
    } catch (const Error& failure) {
      file_calls().remove_all(to);
      const bool is_there = fs::is_directory(from, error);
      if (is_there && (again || failure.code() != ErrorCode::kBadInput)) throw;
    }
  }
}

std::vector<std::string> copy_all(const InstrumentPaths& instrument, const fs::path& to, bool with_results) {
  copy_database_in_use(instrument.state_dir / kDatabaseFile, to / kDatabaseFile);
  {
    Database copy(to / kDatabaseFile);
    note_running_jobs(copy, utc_now());
  }
  for (const char* name : kStateFiles) copy_durably(instrument.state_dir / name, to / "state" / name);
  copy_durably(instrument.recipe_dir, to / "recipes");
  copy_durably(instrument.config_file, to / kConfigFile);
  copy_durably(instrument.config_file.parent_path() / kConfigParts, to / kConfigParts);
  copy_durably(instrument.stage_profile, to / kStageProfile);
  copy_durably(instrument.token_file, to / kTokenFile);
  std::vector<std::string> missing;
  if (!with_results) return missing;
  // Every row of the copy was written after its folder, and folders of results do not change but by whole files.
  for (const std::string& name : results_in(to / kDatabaseFile)) {
    const fs::path folder = instrument.state_dir / "results" / name;
    if (!copy_result(folder, to / "results" / name)) missing.push_back(name);
  }
  return missing;
}

/// Of a disk that is not mounted the mount point may be missing: a folder made there would be on the system's disk.
void require_place(const fs::path& backup, const fs::path& state_dir) {
  const fs::path parent = backup.parent_path();
  if (std::error_code error; !fs::is_directory(parent, error)) {
    throw Error(ErrorCode::kBadInput, "there is no folder " + parent.string() +
                                          " to keep the backup in: is its disk mounted? Make it, or give another");
  }
  const fs::path inside = fs::canonical(parent).lexically_relative(fs::weakly_canonical(state_dir));
  if (!inside.empty() && *inside.begin() != "..") {
    throw Error(ErrorCode::kBadInput,
                backup.string() + " is inside of the state folder " + state_dir.string() +
                    ", with which it would be lost: give a folder elsewhere, best on another disk");
  }
}

}  // namespace

std::vector<std::string> make_backup(const InstrumentPaths& instrument, const fs::path& folder, bool with_results) {
  fs::path final_dir = fs::absolute(folder).lexically_normal();
  if (!final_dir.has_filename()) final_dir = final_dir.parent_path();  // "DIR/"
  std::error_code error;
  if (fs::exists(final_dir, error)) {
    throw Error(ErrorCode::kBadInput, final_dir.string() + " exists already: give another name, or move it away");
  }
  const fs::path temporary = final_dir.string() + ".tmp";
  require_place(final_dir, instrument.state_dir);
  if (file_calls().make_directory(temporary) != 0) {
    if (errno != EEXIST) throw storage_error(errno, "create directory", temporary);
    throw Error(ErrorCode::kBadInput, temporary.string() +
                                          " exists: another backup is being made, or one was cut off: give another "
                                          "name, or remove it");
  }
  try {
    std::vector<std::string> missing = copy_all(instrument, temporary, with_results);
    sync_directory(temporary);
    if (file_calls().rename_to_new(temporary, final_dir) != 0) throw storage_error(errno, "rename to", final_dir);
    try {
      sync_directory(final_dir.parent_path());
    } catch (...) {
      if (file_calls().rename(final_dir, temporary) != 0) file_calls().remove_all(final_dir);
      throw;
    }
    return missing;
  } catch (...) {
    file_calls().remove_all(temporary);
    throw;
  }
}

}  // namespace fvd
