#pragma once

/// What the API needs of the recipes at hand; tests put a fake in its place.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "daemon/recipes/recipe.hpp"
#include "daemon/recipes/recipe_versions.hpp"

namespace fvd {

/// A recipe at hand.
struct RecipeEntry {
  std::string id;
  bool edited = false;
  std::int64_t version = 0;                       ///< of the edited one; 0 = the shipped one
  std::optional<ErrorCode> error = std::nullopt;  ///< why no job can use it; version is 0 where it could not be read
  std::string error_message = {};
};

/// What a document is worth as a recipe.
struct RecipeCheck {
  std::string refusal;             ///< every problem with its place; empty = accepted
  std::vector<std::string> notes;  ///< what the author should know although it is accepted
  std::string sha256;              ///< empty where it is refused
};

/// A document to be kept, and who asks for it.
struct RecipeSave {
  std::string id;
  std::string text;
  std::int64_t base_version = 0;  ///< the version that the text was made from; 0 = the shipped one, or a new recipe
  std::string author;             ///< 1..64 printable ASCII characters
  std::string comment;            ///< 0..200 bytes
};

/// context: every function thread-safe; blocks for files and the database, so never called on the network thread.
class RecipeService {
 public:
  virtual ~RecipeService() = default;

  /// Sorted by id; one that cannot be used is among them with its error. Throws Error kBadInput if a folder cannot be
  /// read.
  [[nodiscard]] virtual std::vector<RecipeEntry> list() const = 0;
  /// The text in force and its version, 0 = the shipped one, of which only id, version, sha256 and text are told.
  /// Throws Error kUnknownRecipe naming those that are known, kBadInput if it cannot be read.
  [[nodiscard]] virtual RecipeVersion get(const std::string& id) const = 0;
  /// Throws Error kUnknownRecipe, kBadInput, kBadRecipe with every problem and its JSON pointer.
  [[nodiscard]] virtual Recipe load(const std::string& id) const = 0;

  /// Keys, values, and the limits of the stage; keeps nothing.
  [[nodiscard]] virtual RecipeCheck check(const std::string& text, const std::string& id) const = 0;

  /// Keeps the document as a new version and puts it in force; returns the version. A document that is in force
  /// already makes no new one. Throws Error kRecipeConflict if the version in force is not the base, naming who saved
  /// it and when; kBadInput for an unusable id, author or comment, or one recipe too many; kBadRecipe, kStorageFull,
  /// kStorageWrite, kDatabase. Nothing has changed then.
  virtual std::int64_t save(const RecipeSave& request) = 0;

  /// Newest first, without texts. Throws Error kUnknownRecipe.
  [[nodiscard]] virtual std::vector<RecipeVersion> versions(const std::string& id) const = 0;

  /// Saves the text of an earlier version, or of the shipped recipe (0), as a new version. base_version, author: as in
  /// save(). Masks are as they are now. Throws as save(), kUnknownRecipe if there is no such version.
  virtual std::int64_t restore(const std::string& id, std::int64_t version, std::int64_t base_version,
                               const std::string& author) = 0;
};

}  // namespace fvd
