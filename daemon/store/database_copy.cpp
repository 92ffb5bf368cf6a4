#include "daemon/store/database_copy.hpp"

#include <chrono>
#include <memory>
#include <system_error>
#include <thread>

#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// All at once: a copy in steps begins anew whenever somebody else commits. The write-ahead log keeps writers going.
constexpr int kAllPages = -1;
constexpr int kBusyTries = 100;
constexpr std::chrono::milliseconds kBusyPause{50};

void copy_pages(sqlite3* source, Database& copy) {
  struct Finish {
    void operator()(sqlite3_backup* backup) const noexcept { sqlite3_backup_finish(backup); }
  };
  std::unique_ptr<sqlite3_backup, Finish> backup(sqlite3_backup_init(copy.handle(), "main", source, "main"));
  if (backup == nullptr) copy.fail("copying");
  int code = SQLITE_OK;
  for (int tries = 0; tries < kBusyTries; ++tries) {
    code = sqlite3_backup_step(backup.get(), kAllPages);
    if (code != SQLITE_BUSY && code != SQLITE_LOCKED) break;
    std::this_thread::sleep_for(kBusyPause);  // until a checkpoint of its writer is done
  }
  backup.reset();
  if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) {
    throw Error(ErrorCode::kDatabase, std::string("the database ") + sqlite3_db_filename(source, "main") +
                                          " cannot be copied, it is damaged: " + sqlite3_errstr(code));
  }
  if (code != SQLITE_DONE) {
    throw Error(code == SQLITE_FULL ? ErrorCode::kStorageFull : ErrorCode::kDatabase,
                "cannot copy the database to " + copy.file().string() + ": " + sqlite3_errstr(code));
  }
}

void copy_to(const fs::path& copy, sqlite3* source) {
  const fs::path temporary = fs::path(copy) += ".tmp";
  remove_file(temporary);  // of a process that was killed
  try {
    {
      Database target(temporary);
      copy_pages(source, target);
      // One file from here on: as a log it would need two more beside it.
      target.execute("PRAGMA journal_mode=DELETE");
    }
    if (file_calls().rename(temporary, copy) != 0) throw storage_error(errno, "rename the copy to", copy);
    sync_directory(fs::absolute(copy).parent_path());
  } catch (...) {
    file_calls().unlink(temporary);
    throw;
  }
}

}  // namespace

void copy_database(const Database& source, const fs::path& copy) { copy_to(copy, source.handle()); }

void copy_database_in_use(const fs::path& source, const fs::path& copy) {
  struct Close {
    void operator()(sqlite3* handle) const noexcept { sqlite3_close(handle); }
  };
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(source.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  const std::unique_ptr<sqlite3, Close> handle(opened);
  if (code != SQLITE_OK) {
    throw Error(ErrorCode::kDatabase, "cannot open the database " + source.string() + ": " + sqlite3_errstr(code) +
                                          ": is it there, and may you read and write it?");
  }
  copy_to(copy, handle.get());
}

void note_running_jobs(Database& copy, const std::string& copied_utc) {
  Statement(copy, "UPDATE jobs SET error_message = ?, ended_utc = ? WHERE state = ? AND error_message = ''")
      .bind(
          "the backup was made while the job ran, and does not have its result: measure the part again with a new "
          "sequence number")
      .bind(copied_utc)
      .bind(job_state_name(JobState::kProcessing))
      .run();
}

}  // namespace fvd
