#include "daemon/store/database.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>

#include "core/base/error.hpp"

namespace fvd {

namespace {

constexpr int kBusyTimeout_ms = 1000;  // until a killed predecessor's lock is gone
constexpr int kLockPoll_ms = 10;

bool means_disk_full(int code, int system_errno) {
  if (code == SQLITE_FULL) return true;
  return code == SQLITE_IOERR && (system_errno == ENOSPC || system_errno == EDQUOT);
}

std::string advice(int code) {
  switch (code) {
    case SQLITE_BUSY:
      return "; is another fvd running with the same state_dir?";
    case SQLITE_CANTOPEN:
      return "; does its folder exist, and may fvd write there?";
    case SQLITE_READONLY:
      return "; may fvd write there?";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return "; move the file away to start anew, results on disk are kept";
    default:
      return "";
  }
}

}  // namespace

Database::Database(const std::filesystem::path& file, int flags) : file_(file) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (handle == nullptr) throw Error(ErrorCode::kDatabase, "no memory to open the database " + file.string());
  if (code != SQLITE_OK) fail("opening");
  sqlite3_extended_result_codes(handle, 0);
  sqlite3_busy_timeout(handle, kBusyTimeout_ms);
}

Database::Database(const std::filesystem::path& file) : Database(file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) {
  take_the_file();
}

Database Database::reader_of(const Database& owner) {
  Database reader(owner.file_, SQLITE_OPEN_READWRITE);
  reader.execute("PRAGMA query_only=ON");
  return reader;
}

void Database::take_the_file() {
  // SQLite's own exclusive mode would keep our second connection out as well.
  lock_ = UniqueFd(::open(file_.c_str(), O_RDONLY | O_CLOEXEC));
  for (int waited_ms = 0; ::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0; waited_ms += kLockPoll_ms) {
    const int reason = errno;
    if (reason != EWOULDBLOCK) {
      throw Error(ErrorCode::kDatabase, "database " + file_.string() + ": locking: " + std::strerror(reason));
    }
    if (waited_ms >= kBusyTimeout_ms) {
      throw Error(ErrorCode::kBusy, "database " + file_.string() +
                                        " is in use; is another fvd running with the same state_dir? Stop it first");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(kLockPoll_ms));  // flock() knows no deadline
  }
}

void Database::use_write_ahead_log() {
  Statement mode(*this, "PRAGMA journal_mode=WAL");
  const std::string in_force = mode.step() ? mode.text(0) : "";
  if (in_force != "wal") {
    throw Error(ErrorCode::kDatabase, "database " + file_.string() +
                                          ": no write-ahead log is possible here, the journal is '" + in_force +
                                          "': put state_dir on a local file system");
  }
  execute("PRAGMA synchronous=FULL");
}

void Database::move_log() {
  // A connection that has read nothing yet does not know of the log, and would move nothing.
  execute("PRAGMA schema_version");
  int in_log = -1;
  const int code = sqlite3_wal_checkpoint_v2(handle_.get(), nullptr, SQLITE_CHECKPOINT_PASSIVE, &in_log, nullptr);
  if (code == SQLITE_BUSY || code == SQLITE_LOCKED) return;
  if (code != SQLITE_OK || in_log < 0) fail("moving the write-ahead log");
}

void Database::execute(const char* sql) {
  if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(sql);
}

void Database::fail(std::string_view what) const {
  const int code = sqlite3_errcode(handle_.get());
  const std::string reason = sqlite3_errmsg(handle_.get());
  if (means_disk_full(code, sqlite3_system_errno(handle_.get()))) {
    throw Error(ErrorCode::kStorageFull, "no space left for the database " + file_.string() + ": free some disk space");
  }
  throw Error(ErrorCode::kDatabase,
              "database " + file_.string() + ": " + std::string(what) + ": " + reason + advice(code));
}

Statement::Statement(const Database& database, const char* sql) : database_(database) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database.handle(), sql, -1, &statement, nullptr) != SQLITE_OK) database.fail(sql);
  statement_.reset(statement);
}

Statement& Statement::bind(std::int64_t value) {
  if (sqlite3_bind_int64(statement_.get(), ++bound_, value) != SQLITE_OK) database_.fail("binding a number");
  return *this;
}

Statement& Statement::bind(std::string_view text) {
  const char* bytes = text.data() == nullptr ? "" : text.data();  // nullptr would bind NULL
  if (sqlite3_bind_text64(statement_.get(), ++bound_, bytes, text.size(), SQLITE_TRANSIENT, SQLITE_UTF8) != SQLITE_OK) {
    database_.fail("binding a text");
  }
  return *this;
}

Statement& Statement::bind(const std::optional<double>& number) {
  const int bound =
      number ? sqlite3_bind_double(statement_.get(), ++bound_, *number) : sqlite3_bind_null(statement_.get(), ++bound_);
  if (bound != SQLITE_OK) database_.fail("binding a number");
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_.fail(sqlite3_sql(statement_.get()));
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

std::int64_t Statement::integer(int column) const noexcept { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes == nullptr ? std::string() : std::string(bytes, size);
}

std::optional<double> Statement::real(int column) const noexcept {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}

Transaction::Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  // A failed commit may have rolled back by itself; then there is nothing to do.
  if (!committed_ && sqlite3_get_autocommit(database_.handle()) == 0) {
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  committed_ = true;
}

}  // namespace fvd
