#pragma once

/// Which jobs have their result on the disk, in the job database.

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// context: thread-safe; a reader waits for other readers, never for a commit.
class ResultTable {
 public:
  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  ResultTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  /// The jobs whose results are on the disk, the oldest first; without the texts of the results. Throws Error
  /// kDatabase, as the next ones.
  [[nodiscard]] std::vector<StoredJob> on_disk() const;
  /// The jobs that ended without a result: interrupted, failed, aborted.
  [[nodiscard]] std::vector<JobStatus> without_result() const;
  /// How many were interrupted, of all starts.
  [[nodiscard]] std::uint64_t count_of_interrupted() const;
  /// Notes, durably, that the job's result is removed, and forgets its text. False, and nothing is noted, unless the
  /// job was acknowledged. Throws Error kStorageFull, too.
  bool mark_removed(const std::string& job_id);
  /// The ids of the hundred jobs whose results were removed last.
  [[nodiscard]] std::vector<std::string> removed_last() const;

 private:
  const Connection writer_;
  const Connection reader_;
};

}  // namespace fvd
