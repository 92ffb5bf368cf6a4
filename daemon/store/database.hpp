#pragma once

/// SQLite's handles as C++ expects them; its error codes become Error kDatabase, a full disk kStorageFull.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <sqlite3.h>

#include "daemon/base/unique_fd.hpp"

namespace fvd {

/// One connection. context: one thread at a time.
class Database {
 public:
  /// Opens or creates the file; its folder must exist. Writes nothing to a file that is there. No other Database of
  /// this kind, of this or another process, opens the file until destruction. Throws Error kDatabase naming the file
  /// and the reason, kBusy while another one has it, kStorageFull.
  explicit Database(const std::filesystem::path& file);
  /// A second connection to an open one's file, which sees what was committed and waits for no commit. Writing through
  /// it fails. `owner` outlives it. Throws Error kDatabase.
  [[nodiscard]] static Database reader_of(const Database& owner);

  /// From here on with a write-ahead log and synchronous=FULL: a commit that returned survives a power cut, and readers
  /// do not wait for it. Throws Error kDatabase, also where the file system cannot do that, kStorageFull.
  void use_write_ahead_log();

  /// Moves what the write-ahead log holds into the file, as far as no reader still needs it there; waits for nobody,
  /// and no commit waits for it. Throws Error kDatabase, kStorageFull.
  void move_log();

  /// Runs statements without results. Throws Error kDatabase, kStorageFull.
  void execute(const char* sql);

  [[nodiscard]] sqlite3* handle() const noexcept { return handle_.get(); }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// Throws the connection's latest error. what: what was tried, e.g. "storing the job".
  [[noreturn]] void fail(std::string_view what) const;

 private:
  Database(const std::filesystem::path& file, int flags);
  /// Keeps every other owner out.
  void take_the_file();

  struct Closer {
    void operator()(sqlite3* handle) const noexcept { sqlite3_close(handle); }
  };
  std::filesystem::path file_;
  UniqueFd lock_;  // closed after the connection: closing any descriptor of the file drops the connection's locks
  std::unique_ptr<sqlite3, Closer> handle_;
};

/// One prepared statement: bind its parameters in order, then step through its rows.
class Statement {
 public:
  Statement(const Database& database, const char* sql);

  Statement& bind(std::int64_t value);
  /// The text is copied; it may hold any bytes.
  Statement& bind(std::string_view text);
  /// NULL for nothing.
  Statement& bind(const std::optional<double>& number);

  /// True while there is a row. Throws Error kDatabase, kStorageFull.
  [[nodiscard]] bool step();
  /// Runs a statement that gives no rows.
  void run();

  /// Columns of the current row, from 0; NULL reads as 0 or "".
  [[nodiscard]] std::int64_t integer(int column) const noexcept;
  [[nodiscard]] std::string text(int column) const;
  /// Nothing for NULL.
  [[nodiscard]] std::optional<double> real(int column) const noexcept;

 private:
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
  };
  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  int bound_ = 0;
};

/// All or nothing: rolled back unless commit() returned.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool committed_ = false;
};

}  // namespace fvd
