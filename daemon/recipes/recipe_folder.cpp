#include "daemon/recipes/recipe_folder.hpp"

#include <algorithm>
#include <cerrno>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/recipes/recipe_document.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNextSuffix = ".new";

fs::path file_of(const fs::path& folder, const std::string& id) {
  if (!is_recipe_id(id)) {
    throw Error(ErrorCode::kUnknownRecipe, "a recipe id has 1 to 32 of the characters A-Z a-z 0-9 _ -");
  }
  return folder / (id + ".json");
}

fs::path next_of(const fs::path& folder, const std::string& id) { return file_of(folder, id) += kNextSuffix; }

}  // namespace

namespace {

/// Throws Error kBadInput where the disk does not tell: a recipe that cannot be seen is not one that is absent.
bool is_there(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (error) throw Error(ErrorCode::kBadInput, "cannot read " + file.string() + ": " + error.message());
  return true;
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
  if (!is_there(file)) return std::nullopt;
  return read_text_file(file);
}

void write_next_recipe_text(const fs::path& folder, const std::string& id, std::string_view text) {
  const fs::path next = next_of(folder, id);
  remove_file(next);  // of a process that died while it wrote
  write_new_file(next, text);
  try {
    sync_directory(folder);
  } catch (...) {
    file_calls().unlink(next);
    throw;
  }
}

std::optional<std::string> find_next_recipe_text(const fs::path& folder, const std::string& id) {
  const fs::path next = next_of(folder, id);
  if (!is_there(next)) return std::nullopt;
  return read_text_file(next);
}

void put_next_recipe_text_in_force(const fs::path& folder, const std::string& id) {
  const fs::path file = file_of(folder, id);
  if (file_calls().rename(next_of(folder, id), file) != 0) throw storage_error(errno, "replace", file);
}

void drop_next_recipe_text(const fs::path& folder, const std::string& id) { file_calls().unlink(next_of(folder, id)); }

std::vector<std::string> list_next_recipe_texts(const fs::path& folder) {
  std::vector<std::string> ids;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path file = entry->path().stem();  // <id>.json
    const std::string id = file.stem().string();
    if (entry->path().extension() == kNextSuffix && file.extension() == ".json" && is_recipe_id(id)) ids.push_back(id);
  }
  return ids;
}

}  // namespace fvd
