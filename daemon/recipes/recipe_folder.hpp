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

/// A text that is to replace the file waits beside it, as <id>.json.new, until it is decided that it does. Each throws
/// Error kUnknownRecipe for what is no id.
/// Writes the text that waits, on the disk at the return. Throws Error kStorageFull, kStorageWrite; none waits then.
void write_next_recipe_text(const std::filesystem::path& folder, const std::string& id, std::string_view text);
/// Throws Error kBadInput if it cannot be read.
[[nodiscard]] std::optional<std::string> find_next_recipe_text(const std::filesystem::path& folder,
                                                               const std::string& id);
/// Puts the text that waits in place of the file: a power cut leaves the old text and the one that waits, or the new
/// one. Throws Error kStorageWrite; it still waits then.
void put_next_recipe_text_in_force(const std::filesystem::path& folder, const std::string& id);
void drop_next_recipe_text(const std::filesystem::path& folder, const std::string& id);
/// Ids of the recipes that have a text that waits; none where there is no folder.
[[nodiscard]] std::vector<std::string> list_next_recipe_texts(const std::filesystem::path& folder);

}  // namespace fvd
