#pragma once

/// Who asked for what, in the job database.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

struct AuditEntry {
  std::int64_t number = 0;  ///< counts the rows; given by the table
  std::string time_utc;     ///< "2026-11-30T10:00:00.000Z"
  std::string who;          ///< by what the caller was recognised
  std::string role;         ///< that he had
  std::string peer;         ///< address of his connection
  std::string client;       ///< what he calls himself
  std::string what;         ///< the method, or an event of the daemon
  std::string detail;       ///< parameters, shortened
  std::string outcome;      ///< "ok", or the error's name; "accepted": it goes on, and a row with its end follows
  bool is_end = false;      ///< of what was accepted; not kept in the table
};

/// The newest hundred thousand rows are kept. context: thread-safe; a reader waits for other readers, never for a
/// commit.
class AuditTable {
 public:
  static constexpr std::int64_t kRowsKept = 100'000;

  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  AuditTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  /// All of them, in their order, or none; durable at the return. Throws Error kDatabase, kStorageFull.
  void add(const std::vector<AuditEntry>& entries);
  /// At most so many, the newest first; before: only rows with a smaller number, 0 = all. Throws Error kDatabase.
  [[nodiscard]] std::vector<AuditEntry> newest(int most, std::int64_t before = 0) const;

 private:
  const Connection writer_;
  const Connection reader_;
};

}  // namespace fvd
