#pragma once

/// The recipes of one folder.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "daemon/jobs/services.hpp"
#include "daemon/recipes/recipe_book.hpp"

namespace fvd {

/// context: thread-safe.
class RecipeFolder final : public RecipeService {
 public:
  explicit RecipeFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] std::vector<std::string> recipe_ids() const override { return list_recipes(folder_); }
  [[nodiscard]] std::string recipe_json(const std::string& recipe_id) const override {
    return recipe_text(folder_, recipe_id);
  }
  /// Throws as load_recipe() does.
  [[nodiscard]] Recipe load(const std::string& recipe_id) const { return load_recipe(folder_, recipe_id); }

 private:
  const std::filesystem::path folder_;
};

}  // namespace fvd
