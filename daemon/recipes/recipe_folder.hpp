#pragma once

/// A folder of recipes, <id>.json, read anew whenever one is asked for.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fvd {

/// Ids of the recipes in the folder, sorted; files of other names are no recipes. Throws Error kBadInput if the folder
/// cannot be read.
[[nodiscard]] std::vector<std::string> list_recipes(const std::filesystem::path& folder);

/// The file's text as it stands; nothing if there is no such file. Throws Error kUnknownRecipe for what is no id,
/// kBadInput if it cannot be read.
[[nodiscard]] std::optional<std::string> find_recipe_text(const std::filesystem::path& folder, const std::string& id);

/// Puts the text in place of the file, so that a power cut leaves the old text or the new one. Throws Error
/// kUnknownRecipe for what is no id, kStorageFull, kStorageWrite; the old text is there then.
void replace_recipe_text(const std::filesystem::path& folder, const std::string& id, std::string_view text);

}  // namespace fvd
