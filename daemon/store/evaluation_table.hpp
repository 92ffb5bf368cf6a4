#pragma once

/// Results that were evaluated anew by other recipes, in the job database.

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

struct StoredEvaluation {
  std::string id;           ///< the job's with "-e1", "-e2", ...
  std::string job_id;       ///< whose surface was evaluated
  std::int64_t number = 0;  ///< of the job's evaluations, from 1
  std::string recipe;
  std::string recipe_sha256;
  std::string verdict;      ///< pass, fail, uncertain, invalid; empty = nothing was judged
  std::string result_dir;   ///< with its files
  std::string result_json;  ///< text of result.json
};

/// The id of a job's evaluation.
[[nodiscard]] std::string evaluation_id(const std::string& job_id, std::int64_t number);

/// Rows are added and never changed. context: thread-safe; a reader waits for other readers, never for a commit.
class EvaluationTable {
 public:
  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  EvaluationTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  /// Throws Error kDatabase, as the next ones.
  [[nodiscard]] std::optional<StoredEvaluation> find(const std::string& id) const;
  /// Of the job's newest evaluation; 0 before the first.
  [[nodiscard]] std::int64_t newest_number(const std::string& job_id) const;
  /// Durable at the return. Throws also where the id is there already, and kStorageFull.
  void add(const StoredEvaluation& evaluation);

 private:
  const Connection writer_;
  const Connection reader_;
};

}  // namespace fvd
