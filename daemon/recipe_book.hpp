#pragma once

/// Recipes: a folder of JSON files, read anew for every job.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "daemon/recipe.hpp"

namespace fvd {

/// Every key with its range and meaning.
void describe(Recipe& recipe, Fields& fields);

/// Ids of the recipes in the folder, sorted. Throws Error kBadInput if it cannot be read.
[[nodiscard]] std::vector<std::string> list_recipes(const std::filesystem::path& folder);

/// The file's text. Throws Error kUnknownRecipe, also for an id that is no plain name.
[[nodiscard]] std::string recipe_text(const std::filesystem::path& folder, const std::string& id);

/// Throws Error kUnknownRecipe, kBadRecipe with every problem and its JSON pointer.
[[nodiscard]] Recipe load_recipe(const std::filesystem::path& folder, const std::string& id);
[[nodiscard]] Recipe parse_recipe(std::string_view text, const std::string& id);

/// The JSON schema of a recipe; config/recipe.schema.json is this text.
[[nodiscard]] std::string recipe_schema_text();

}  // namespace fvd
