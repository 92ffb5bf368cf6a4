#pragma once

/// Recipes: a folder of JSON files, <id>.json, read anew whenever one is asked for.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "core/base/units.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

/// Every key with its range and meaning: the one place that defines them.
void describe(Recipe& recipe, Fields& fields);

/// True for 1..32 characters out of A-Z a-z 0-9 _ -, which no path can be made of.
[[nodiscard]] bool is_recipe_id(std::string_view id) noexcept;

/// Ids of the recipes in the folder, sorted; files of other names are no recipes. Throws Error kBadInput if the folder
/// cannot be read.
[[nodiscard]] std::vector<std::string> list_recipes(const std::filesystem::path& folder);

/// The file's text as it stands. Throws Error kUnknownRecipe, also for what is no id; kBadInput if it cannot be read.
[[nodiscard]] std::string recipe_text(const std::filesystem::path& folder, const std::string& id);

/// Throws Error kUnknownRecipe, kBadInput, or kBadRecipe with every problem and its JSON pointer.
[[nodiscard]] Recipe load_recipe(const std::filesystem::path& folder, const std::string& id);

/// Throws Error kBadRecipe likewise.
[[nodiscard]] Recipe parse_recipe(std::string_view json_text, const std::string& id);

/// What of the recipe would leave the stage's limits: the take-up below the first slice, and the last slice.
[[nodiscard]] Problems check_stage_limits(const Recipe& recipe, Micrometers min, Micrometers max, Micrometers take_up);

/// JSON Schema of a recipe; config/recipe.schema.json is this text.
[[nodiscard]] std::string recipe_schema_text();

}  // namespace fvd
