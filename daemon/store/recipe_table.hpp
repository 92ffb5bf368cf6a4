#pragma once

/// The versions of edited recipes in the job database.

#include "core/base/mutex.hpp"
#include "daemon/recipes/recipe_versions.hpp"
#include "daemon/store/database.hpp"

namespace fvd {

/// context: thread-safe; a reader waits for other readers, never for a commit.
class RecipeTable final : public RecipeVersions {
 public:
  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What they refer to outlives the table.
  RecipeTable(Connection writer, Connection reader) : writer_(writer), reader_(reader) {}

  [[nodiscard]] std::vector<RecipeVersion> list(const std::string& id) const override;
  [[nodiscard]] std::optional<RecipeVersion> find(const std::string& id, std::int64_t version) const override;
  [[nodiscard]] std::optional<RecipeVersion> latest(const std::string& id) const override;
  RecipeVersion add(const RecipeVersion& version, int kept) override;
  void remove(const std::string& id, std::int64_t version) override;

 private:
  const Connection writer_;
  const Connection reader_;
};

}  // namespace fvd
