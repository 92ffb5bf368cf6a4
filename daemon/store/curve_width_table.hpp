#pragma once

/// The width of the focus curve as the last good scans of each recipe told it, in the job database.

#include <map>
#include <optional>
#include <string>

#include "core/base/mutex.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

/// One row a recipe: a width belongs to the settings that it was measured with, and another recipe document of the same
/// name that changes one of them starts anew. What was found or learnt is remembered: a job asks between its trigger
/// and the first motion, and does not wait for the readers of rows. context: thread-safe; a reader waits for other
/// readers, never for a commit.
class CurveWidthTable {
 public:
  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  CurveWidthTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  /// Nothing before the first good scan with these settings. Throws Error kDatabase, as the next.
  [[nodiscard]] std::optional<LearntWidth> find(const Recipe& recipe) const;
  /// Takes in what a good scan told: of the width, > 0 um, a mean in which the last five scans weigh most; of the bins
  /// the smallest number of slices that one of them allowed. Durable at the return.
  void learn(const Recipe& recipe, double width_um, int most_bin_slices);

 private:
  struct Known {
    std::string settings;
    std::optional<LearntWidth> learnt;
  };

  const Connection writer_;
  const Connection reader_;
  mutable Mutex known_mutex_;  // taken before the reader's and behind the writer's
  mutable std::map<std::string, Known> known_ FVD_GUARDED_BY(known_mutex_);  // by recipe
};

}  // namespace fvd
