#pragma once

/// Which objective was confirmed to be on the microscope, in the job database.

#include <optional>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

struct ObjectiveConfirmation {
  std::string objective;      ///< its name in the configuration of that time
  std::string person;         ///< who said so
  std::string confirmed_utc;  ///< "2026-11-29T10:00:00.000Z"
};

/// One row for each time that somebody confirmed one; none is ever deleted.
/// context: thread-safe; a reader waits for other readers, never for a commit.
class ObjectiveTable {
 public:
  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  ObjectiveTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  /// The newest; nothing before the first. Throws Error kDatabase.
  [[nodiscard]] std::optional<ObjectiveConfirmation> latest() const;
  /// Durable at the return. Throws Error kDatabase, kStorageFull.
  ObjectiveConfirmation add(const std::string& objective, const std::string& person);

 private:
  const Connection writer_;
  const Connection reader_;
};

}  // namespace fvd
