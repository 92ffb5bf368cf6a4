#pragma once

/// SQLite's handles as C++ expects them; errors become Error kDatabase or kStorageFull.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <sqlite3.h>

namespace fvd {

class Database {
 public:
  /// Throws Error kDatabase naming the file.
  explicit Database(const std::filesystem::path& file);

  /// Runs statements without results.
  void execute(const char* sql);
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Closer {
    void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  };
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Closer> handle_;
};

/// One statement: bind in order, then step through its rows.
class Statement {
 public:
  Statement(const Database& database, const char* sql);

  Statement& bind(std::int64_t value);
  Statement& bind(std::string_view text);
  /// True while there is a row.
  [[nodiscard]] bool step();
  /// Runs to the end.
  void run();
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;

 private:
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  int bound_ = 0;
};

/// All or nothing: rolled back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool done_ = false;
};

}  // namespace fvd
