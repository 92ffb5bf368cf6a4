#include "daemon/backup/restore.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "daemon/access/role.hpp"
#include "daemon/backup/copied_files.hpp"
#include "daemon/backup/state_files.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/store/audit_table.hpp"
#include "daemon/store/database_copy.hpp"
#include "daemon/store/job_status.hpp"
#include "daemon/store/migrations.hpp"
#include "daemon/store/store_marker.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// Starts of a machine that is lost count for nothing that could be known here.
constexpr std::int64_t kUnknownStarts = 1000;

struct Known {
  std::int64_t epoch = 0;
  NewestSeqs newest_seq;
};

void join(NewestSeqs& all, const NewestSeqs& more) {
  for (const auto& [client, seq] : more) all[client] = std::max(all[client], seq);
}

Known known_to(const Database& database) {
  Statement epoch(database, "SELECT epoch FROM starts");
  return {epoch.step() ? epoch.integer(0) : 0, newest_seqs_in(database)};
}

/// What a database that is replaced tells of its numbers.
struct Replaced {
  Known known;
  bool is_older = false;  ///< than what the marker tells of: it does not know all numbers
};

/// Of a database that can be read.
std::optional<Replaced> known_to_the_replaced(const Database& database, const std::optional<StoreMarker>& marker) {
  try {
    return Replaced{known_to(database), marker && is_older(database, *marker)};
  } catch (const Error&) {
    return std::nullopt;  // damaged, or of an older version
  }
}

/// How many numbers above the newest that are known may have been used. A database that a restoration put here, and
/// that no start has taken over since, knows no more than its backup: then it is as the marker says.
std::int64_t margin_of(const std::optional<StoreMarker>& marker, const std::optional<Replaced>& replaced) {
  if (replaced && !replaced->is_older) return 0;
  return marker ? marker->margin : kSeqJump;
}

struct Incoming {
  Known known;
  std::set<std::string> results;  ///< names of the folders that it has rows for
};

Incoming known_to_the_incoming(const Database& database) {
  Incoming incoming{known_to(database), {}};
  Statement names(database, "SELECT job_id FROM jobs UNION ALL SELECT evaluation_id FROM evaluations");
  while (names.step()) incoming.results.insert(names.text(0));
  return incoming;
}

/// Before it is copied: of a damaged copy SQLite would name the copy, which nobody can look after.
void require_undamaged(const Database& backup) {
  const auto first_damage = [&backup]() -> std::string {
    try {
      Statement check(backup, "PRAGMA quick_check(1)");
      std::string found = check.step() ? check.text(0) : "";
      std::replace(found.begin(), found.end(), '\n', ' ');
      if (found != "ok") return found;
      return schema_version(backup) == 0 ? "it has no tables" : "";
    } catch (const Error&) {
      return sqlite3_errmsg(backup.handle());
    }
  };
  const std::string damage = first_damage();
  if (damage.empty()) return;
  throw Error(ErrorCode::kDatabase, "the backup's database " + backup.file().string() + " is damaged: " + damage +
                                        "; nothing was changed, restore another backup");
}

std::string last_written_utc(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return utc_now();
  return utc_text(std::chrono::system_clock::from_time_t(status.st_mtime));
}

/// The backup's database as this version reads it, with the results where they are here.
Incoming prepare_database(const fs::path& from, const fs::path& copy, const fs::path& results) {
  for (const char* log : {"-wal", "-shm"}) {  // of a restoration that was cut off
    remove_file(copy.string() + log);
  }
  {
    const Database backup(from);
    require_undamaged(backup);
    copy_database(backup, copy);
  }
  Database database(copy);
  const fs::path older = copy.string() + ".v" + std::to_string(schema_version(database));
  migrate(database);
  note_running_jobs(database, last_written_utc(from));  // a backup of an earlier version did not
  remove_file(older);                                   // the backup has it
  Transaction transaction(database);
  Statement(database, "UPDATE jobs SET result_dir = ? || '/' || job_id WHERE result_dir <> ''")
      .bind(results.string())
      .run();
  Statement(database, "UPDATE evaluations SET result_dir = ? || '/' || evaluation_id").bind(results.string()).run();
  transaction.commit();
  database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  return known_to_the_incoming(database);
}

/// Who put the backup back, in the database that is about to take the other one's place.
void note_restoration(const fs::path& incoming, const fs::path& folder, std::int64_t epoch) {
  AuditEntry entry;
  entry.time_utc = utc_now();
  entry.who = "uid " + std::to_string(::getuid());
  entry.role = role_name(Role::kAdminister);
  entry.client = "fvdctl";
  entry.what = "restore";
  entry.detail =
      "from " + fs::absolute(folder).lexically_normal().string() + "; the next epoch is " + std::to_string(epoch + 1);
  entry.outcome = "ok";
  Database database(incoming);
  Mutex mutex;
  AuditTable({database, mutex}, {database, mutex}).add({entry});
  database.execute("PRAGMA wal_checkpoint(TRUNCATE)");  // the file alone takes the place
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::exists(from, error)) return;
  (void)make_directories(to.parent_path());
  if (file_calls().rename(from, to) != 0) throw storage_error(errno, "move aside", from);
  sync_directory(to.parent_path());  // before the other folder: else a power cut could leave it in neither
}

constexpr const char* kReplaced = "replaced-";

/// What restorations have replaced, by number.
std::map<int, fs::path> replaced_in(const fs::path& state) {
  const std::string prefix = kReplaced;
  std::map<int, fs::path> replaced;
  std::error_code error;
  for (fs::directory_iterator entry(state, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::string digits = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
    const bool is_number =
        !digits.empty() && digits.size() < 9 && digits.find_first_not_of("0123456789") == digits.npos;
    if (is_number) replaced.emplace(std::stoi(digits), entry->path());
  }
  return replaced;
}

/// Its number is higher than that of any other.
fs::path unused_folder(const fs::path& state) {
  const auto replaced = replaced_in(state);
  return state / (kReplaced + std::to_string(replaced.empty() ? 1 : replaced.rbegin()->first + 1));
}

/// Of what restorations have replaced, all that is older than the two newest databases; told. What cannot be removed
/// stays.
std::vector<fs::path> drop_oldest_replaced(const fs::path& state) {
  constexpr int kKept = 2;
  const std::map<int, fs::path> replaced = replaced_in(state);
  std::error_code error;
  std::vector<fs::path> dropped;
  int databases = 0;
  for (auto newest = replaced.rbegin(); newest != replaced.rend(); ++newest) {
    if (databases == kKept) {
      file_calls().remove_all(newest->second);
      if (!fs::exists(newest->second, error)) dropped.push_back(newest->second);
    } else if (fs::exists(newest->second / "fvd.sqlite", error)) {
      ++databases;  // what an attempt that failed left has none, and does not push out the one that has
    }
  }
  return dropped;
}

/// Of what is copied; what a restoration that was cut off left under such a name is no copy.
constexpr const char* kUnfinished = ".restored.tmp";

/// Whatever happens meanwhile, there is either all of it or nothing.
void copy_whole(const fs::path& from, const fs::path& hidden, const fs::path& to) {
  file_calls().remove_all(hidden);
  copy_durably(from, hidden);
  if (file_calls().rename(hidden, to) != 0) throw storage_error(errno, "rename the copy to", to);
}

/// Of a folder the entries: it may be there, empty, and have an owner or a disk of its own. As long as it is not
/// filled, a hidden folder in it says so, and a restoration that is repeated goes on.
void put_back_folder_where_missing(const fs::path& from, const fs::path& to, std::vector<std::string>& kept) {
  const fs::path hidden = to / kUnfinished;
  std::error_code error;
  if (fs::exists(to, error) && !fs::exists(hidden, error) &&
      !(fs::is_directory(to, error) && fs::is_empty(to, error))) {
    kept.push_back(to.string());
    return;
  }
  (void)make_directories(hidden);
  for (fs::directory_iterator entry(from, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    std::error_code ignored;
    if (name.string().starts_with('.') || fs::exists(to / name, ignored)) continue;
    copy_whole(entry->path(), hidden / name, to / name);
  }
  if (error) {
    throw Error(ErrorCode::kBadInput, "cannot list " + from.string() + " of the backup: " + error.message());
  }
  sync_directory(to);
  file_calls().remove_all(hidden);
}

void put_back_where_missing(const fs::path& from, const fs::path& to, std::vector<std::string>& kept) {
  std::error_code error;
  if (to.empty() || !fs::exists(from, error)) return;
  if (fs::is_directory(from, error)) return put_back_folder_where_missing(from, to, kept);
  if (fs::exists(to, error)) {
    kept.push_back(to.string());
    return;
  }
  const fs::path hidden = to.parent_path() / ("." + to.filename().string() + kUnfinished);
  (void)make_directories(fs::absolute(to).parent_path());
  copy_whole(from, hidden, to);
  sync_directory(fs::absolute(to).parent_path());
}

int add_results(const fs::path& from, const fs::path& to) {
  int added = 0;
  std::error_code error;
  for (fs::directory_iterator entry(from, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path folder = to / entry->path().filename();
    std::error_code ignored;
    if (fs::exists(folder, ignored)) continue;
    copy_whole(entry->path(), to / ("." + entry->path().filename().string() + kUnfinished), folder);
    ++added;
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw Error(ErrorCode::kBadInput, "cannot list the results in " + from.string() + ": " + error.message());
  }
  // Under its hidden name the next start would remove it.
  sync_directory(to);
  return added;
}

/// The results that are newer than the backup.
std::vector<std::string> results_without(const std::set<std::string>& rows, const fs::path& results) {
  std::vector<std::string> unknown;
  std::error_code error;
  for (fs::directory_iterator entry(results, error), end; !error && entry != end; entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (!name.starts_with('.') && !rows.contains(name)) unknown.push_back(std::move(name));
  }
  std::sort(unknown.begin(), unknown.end());
  return unknown;
}

}  // namespace

Restored restore_backup(const fs::path& folder, const InstrumentPaths& instrument) {
  if (std::error_code error; !fs::exists(folder / kDatabaseFile, error)) {
    throw Error(ErrorCode::kBadInput, folder.string() + " is no backup: it has no " + kDatabaseFile);
  }
  const fs::path state = fs::absolute(instrument.state_dir);
  const fs::path file = state / kDatabaseFile;
  (void)make_directories(state / "results");
  // Held to the end: no daemon starts meanwhile.
  std::error_code ignored;
  const auto held = fs::exists(file, ignored) ? std::make_unique<Database>(file) : nullptr;
  const auto noted = read_marker(file);
  const auto replaced = held ? known_to_the_replaced(*held, noted) : std::nullopt;
  const fs::path incoming = state / "fvd.restored";
  const Incoming backup = prepare_database(folder / kDatabaseFile, incoming, state / "results");

  Restored restored;
  restored.margin = margin_of(noted, replaced);
  StoreMarker marker = noted.value_or(StoreMarker{});
  const bool blind = !replaced && marker.epoch == 0;
  marker.epoch = std::max(marker.epoch, backup.known.epoch) + (blind ? kUnknownStarts : 1);
  join(marker.newest_seq, backup.known.newest_seq);
  if (replaced) {
    marker.epoch = std::max(marker.epoch, replaced->known.epoch + 1);
    join(marker.newest_seq, replaced->known.newest_seq);
  }
  marker.margin = restored.margin;
  restored.epoch = marker.epoch;
  note_restoration(incoming, folder, restored.epoch);
  write_marker(file, marker);  // first: whatever happens from here on, it is not forgotten which numbers may be used

  const fs::path aside = unused_folder(state);
  for (const char* name : {kDatabaseFile, "fvd.sqlite-wal", "fvd.sqlite-shm"}) move(state / name, aside / name);
  for (const char* name : kStateFiles) {
    if (std::error_code error; !fs::exists(folder / "state" / name, error)) continue;
    move(state / name, aside / name);
    copy_durably(folder / "state" / name, state / name);
    give_to_owner_of(state, state / name);
  }
  restored.results = add_results(folder / "results", state / "results");
  restored.unknown = results_without(backup.results, state / "results");
  put_back_where_missing(folder / "recipes", instrument.recipe_dir, restored.kept);
  put_back_where_missing(folder / kConfigFile, instrument.config_file, restored.kept);
  put_back_where_missing(folder / kConfigParts, instrument.config_file.parent_path() / kConfigParts, restored.kept);
  put_back_where_missing(folder / kStageProfile, instrument.stage_profile, restored.kept);
  put_back_where_missing(folder / kTokenFile, instrument.token_file, restored.kept);
  move(incoming, file);  // last: without it the daemon does not start
  give_to_owner_of(state, file);
  give_to_owner_of(state, marker_file(file));
  give_to_owner_of(state, state / "results");
  if (std::error_code error; fs::exists(aside, error)) restored.replaced = aside;
  restored.dropped = drop_oldest_replaced(state);
  return restored;
}

bool is_half_restored(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kUnfinished, error);
}

}  // namespace fvd
