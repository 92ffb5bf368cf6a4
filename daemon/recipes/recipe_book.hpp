#pragma once

/// The recipes of a station: those that were shipped, which nothing here writes, and edited ones that shadow them.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/mutex.hpp"
#include "core/base/units.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/recipes/recipe_service.hpp"

namespace fvd {

struct RecipeFolders {
  std::filesystem::path shipped;
  std::filesystem::path edited;  ///< made when the first recipe is saved
};

/// Masks of regions are read from the shipped folder's masks/, for edited recipes too; see recipe_masks.hpp. list()
/// does not look at them. A file that was changed by hand becomes a version of its own as soon as the book looks at its
/// versions. A file that was removed by hand uncovers the shipped recipe; its versions stay. context: every function
/// thread-safe; blocks for files and the database.
class RecipeBook final : public RecipeService {
 public:
  static constexpr int kVersionsKept = 100;  ///< per recipe
  static constexpr int kMaxEdited = 500;     ///< recipes

  /// versions outlives the book.
  RecipeBook(RecipeFolders folders, StageLimits limits, RecipeVersions& versions);

  [[nodiscard]] std::vector<RecipeEntry> list() const override;
  [[nodiscard]] RecipeVersion get(const std::string& id) const override;
  [[nodiscard]] Recipe load(const std::string& id) const override;
  [[nodiscard]] RecipeCheck check(const std::string& text, const std::string& id) const override;
  std::int64_t save(const RecipeSave& request) override;
  [[nodiscard]] std::vector<RecipeVersion> versions(const std::string& id) const override;
  std::int64_t restore(const std::string& id, std::int64_t version, std::int64_t base_version,
                       const std::string& author) override;

 private:
  /// With the masks of the shipped folder. Throws Error kBadRecipe.
  [[nodiscard]] Recipe parsed_with_masks(const std::string& text, const std::string& id) const;
  /// Of all recipes: whether it is an edited one, by id.
  [[nodiscard]] std::map<std::string, bool> ids() const;
  [[nodiscard]] std::string text_of(const std::string& id, bool& edited) const;
  /// The version in force; 0 where the shipped one is. A file changed by hand is added.
  [[nodiscard]] RecipeVersion current_locked(const std::string& id) const FVD_REQUIRES(mutex_);
  std::int64_t save_locked(const RecipeSave& request) FVD_REQUIRES(mutex_);
  /// File and row, or neither: the text waits beside the file while its row is committed.
  std::int64_t keep_locked(const RecipeVersion& wanted) FVD_REQUIRES(mutex_);
  /// Ends a save that was cut off: the text that waits is put in force if its row is there, and dropped if not.
  void settle_locked(const std::string& id) const FVD_REQUIRES(mutex_);

  const RecipeFolders folders_;
  const StageLimits limits_;
  RecipeVersions& versions_;
  mutable Mutex mutex_;  // held from reading the version in force until the next one is kept
};

}  // namespace fvd
