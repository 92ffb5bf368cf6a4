#pragma once

/// The versions of edited recipes, kept beside their files; daemon/store implements it on the database.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fvd {

struct RecipeVersion {
  std::string id{};          ///< of the recipe
  std::int64_t version = 0;  ///< 1, 2, .. per recipe; never given twice
  std::string sha256{};      ///< of the text
  std::string author{};      ///< who saved it
  std::string comment{};     ///< what the author says of it
  std::string saved_utc{};   ///< ISO 8601, set by the store
  std::string text{};        ///< the document
};

/// context: every function thread-safe; blocks for the database. Every one throws Error kDatabase, kStorageFull.
class RecipeVersions {
 public:
  virtual ~RecipeVersions() = default;

  /// Newest first, without their texts.
  [[nodiscard]] virtual std::vector<RecipeVersion> list(const std::string& id) const = 0;
  [[nodiscard]] virtual std::optional<RecipeVersion> find(const std::string& id, std::int64_t version) const = 0;
  /// Newest of the recipe.
  [[nodiscard]] virtual std::optional<RecipeVersion> latest(const std::string& id) const = 0;

  /// Adds a version, numbered after the newest, and drops all but the newest `kept`; durable at the return.
  virtual RecipeVersion add(const RecipeVersion& version, int kept) = 0;
  /// Takes a version back that could not be put in force.
  virtual void remove(const std::string& id, std::int64_t version) = 0;
};

}  // namespace fvd
