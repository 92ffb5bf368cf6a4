#include "daemon/recipes/recipe_folder.hpp"

#include <algorithm>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/recipes/recipe_document.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

fs::path file_of(const fs::path& folder, const std::string& id) {
  if (!is_recipe_id(id)) {
    throw Error(ErrorCode::kUnknownRecipe, "a recipe id has 1 to 32 of the characters A-Z a-z 0-9 _ -");
  }
  return folder / (id + ".json");
}

}  // namespace

std::vector<std::string> list_recipes(const fs::path& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const std::string id = entry->path().stem().string();
    if (entry->path().extension() == ".json" && is_recipe_id(id) && entry->is_regular_file(ignored)) ids.push_back(id);
  }
  if (error) throw Error(ErrorCode::kBadInput, "cannot list recipes in " + folder.string() + ": " + error.message());
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::optional<std::string> find_recipe_text(const fs::path& folder, const std::string& id) {
  const fs::path file = file_of(folder, id);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  return read_text_file(file);
}

void replace_recipe_text(const fs::path& folder, const std::string& id, std::string_view text) {
  const fs::path file = file_of(folder, id);
  const fs::path fresh = folder / (id + ".json.new");
  std::error_code error;
  fs::remove(fresh, error);  // of a process that died while it wrote
  write_new_file(fresh, text);
  fs::rename(fresh, file, error);
  if (error) {
    std::error_code ignored;
    fs::remove(fresh, ignored);
    throw Error(ErrorCode::kStorageWrite, "cannot replace " + file.string() + ": " + error.message());
  }
  sync_directory(folder);
}

}  // namespace fvd
