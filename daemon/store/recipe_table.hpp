#pragma once

/// The versions of edited recipes in the job database.

#include "core/base/mutex.hpp"
#include "daemon/recipes/recipe_versions.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

/// context: thread-safe; waits for the database's other users.
class RecipeTable final : public RecipeVersions {
 public:
  /// mutex guards the database; both outlive the table.
  RecipeTable(Database& database, Mutex& mutex) : database_(database), mutex_(mutex) {}

  [[nodiscard]] std::vector<RecipeVersion> list(const std::string& id) const override;
  [[nodiscard]] std::optional<RecipeVersion> find(const std::string& id, std::int64_t version) const override;
  [[nodiscard]] std::optional<RecipeVersion> latest(const std::string& id) const override;
  RecipeVersion add(const RecipeVersion& version, int kept, const std::function<void()>& before_commit) override;

 private:
  [[nodiscard]] std::optional<RecipeVersion> latest_locked(const std::string& id) const FVD_REQUIRES(mutex_);

  Database& database_;
  Mutex& mutex_;
};

}  // namespace fvd
