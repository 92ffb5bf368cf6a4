#include "daemon/recipes/recipe_book.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/recipes/recipe_document.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd {

namespace {

constexpr std::size_t kMaxAuthorLength = 64;
constexpr std::size_t kMaxCommentLength = 200;
constexpr const char* kChangedByHand = "the file was changed by hand";

bool is_author(const std::string& author) {
  return !author.empty() && author.size() <= kMaxAuthorLength &&
         std::all_of(author.begin(), author.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void require_plausible(const RecipeSave& request) {
  if (!is_recipe_id(request.id)) {
    throw Error(ErrorCode::kBadInput, "a recipe id has 1 to 32 of the characters A-Z a-z 0-9 _ -");
  }
  if (!is_author(request.author)) {
    throw Error(ErrorCode::kBadInput, "an author has 1 to 64 printable ASCII characters");
  }
  if (request.comment.size() > kMaxCommentLength) {
    throw Error(ErrorCode::kBadInput, "a comment of " + std::to_string(request.comment.size()) +
                                          " bytes is too long; expected at most " + std::to_string(kMaxCommentLength));
  }
}

std::vector<std::string> edited_ids(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return {};
  return list_recipes(folder);
}

}  // namespace

RecipeBook::RecipeBook(RecipeFolders folders, StageLimits limits, RecipeVersions& versions)
    : folders_(std::move(folders)), limits_(limits), versions_(versions) {
  const MutexLock lock(mutex_);
  for (const std::string& id : list_next_recipe_texts(folders_.edited)) settle_locked(id);
}

std::map<std::string, bool> RecipeBook::ids() const {
  std::map<std::string, bool> edited_by_id;
  for (const std::string& id : list_recipes(folders_.shipped)) edited_by_id[id] = false;
  for (const std::string& id : edited_ids(folders_.edited)) edited_by_id[id] = true;
  return edited_by_id;
}

std::vector<RecipeEntry> RecipeBook::list() const {
  std::vector<RecipeEntry> entries;
  for (const auto& [id, edited] : ids()) {
    RecipeEntry& entry = entries.emplace_back(RecipeEntry{id, edited});
    try {
      const RecipeVersion current = get(id);
      entry.version = current.version;
      (void)parse_recipe(current.text, id);
    } catch (const Error& error) {
      entry.error = error.code();
      entry.error_message = error.what();
    }
  }
  return entries;
}

std::string RecipeBook::text_of(const std::string& id, bool& edited) const {
  auto found = find_recipe_text(folders_.edited, id);
  edited = found.has_value();
  if (!found) found = find_recipe_text(folders_.shipped, id);
  if (found) return *std::move(found);
  std::string known;
  for (const auto& [other, ignored] : ids()) known += (known.empty() ? "known are " : ", ") + other;
  throw Error(ErrorCode::kUnknownRecipe,
              "there is no recipe '" + id + "'; " + (known.empty() ? "there are none" : known));
}

RecipeVersion RecipeBook::get(const std::string& id) const {
  // While another client's save brings its text to the disk, the version before it is in force and told at once.
  bool edited = false;
  const std::string text = text_of(id, edited);
  if (!edited) return {.id = id, .sha256 = recipe_sha256(text), .text = text};
  if (auto latest = versions_.latest(id); latest && latest->text == text) return *std::move(latest);
  const MutexLock lock(mutex_);
  return current_locked(id);
}

Recipe RecipeBook::parsed_with_masks(const std::string& text, const std::string& id) const {
  Problems problems;
  Recipe recipe = read_recipe(text, id, problems);
  read_masks(folders_.shipped, recipe.evaluation, problems);
  throw_if_any(problems, ErrorCode::kBadRecipe, "recipe " + id);
  return recipe;
}

Recipe RecipeBook::load(const std::string& id) const {
  bool edited = false;
  Recipe recipe = parsed_with_masks(text_of(id, edited), id);
  for (const std::string& note : recipe.notes) spdlog::warn("recipe {} {}", id, note);
  return recipe;
}

RecipeCheck RecipeBook::check(const std::string& text, const std::string& id) const {
  Problems problems;
  Recipe recipe = read_recipe(text, id, problems);
  read_masks(folders_.shipped, recipe.evaluation, problems);
  for (Problem& found : check_stage_limits(recipe, limits_, problems)) {
    problems.push_back(std::move(found));
  }
  RecipeCheck check;
  if (problems.empty()) {
    check.notes = recipe.notes;
    check.sha256 = recipe.sha256;
  } else {
    check.refusal = to_text(problems, "recipe " + id);
  }
  return check;
}

void RecipeBook::settle_locked(const std::string& id) const {
  try {
    const auto next = find_next_recipe_text(folders_.edited, id);
    if (!next) return;
    const auto latest = versions_.latest(id);
    if (!latest || latest->text != *next) return drop_next_recipe_text(folders_.edited, id);
    put_next_recipe_text_in_force(folders_.edited, id);
    spdlog::warn("recipe {}: version {}, saved by '{}', was not in force yet and is now", id, latest->version,
                 latest->author);
  } catch (const Error& error) {
    spdlog::warn("recipe {}: whether its last change was saved cannot be found out yet: {}", id, error.what());
  }
}

RecipeVersion RecipeBook::current_locked(const std::string& id) const {
  settle_locked(id);
  bool edited = false;
  const std::string text = text_of(id, edited);
  if (!edited) return {.id = id, .sha256 = recipe_sha256(text), .text = text};
  auto latest = versions_.latest(id);
  if (latest && latest->text == text) return *latest;
  const RecipeVersion found{
      .id = id, .sha256 = recipe_sha256(text), .author = "unknown", .comment = kChangedByHand, .text = text};
  RecipeVersion added = versions_.add(found, kVersionsKept);
  spdlog::warn("recipe {}: {}; it is version {} now", id, kChangedByHand, added.version);
  return added;
}

std::int64_t RecipeBook::save(const RecipeSave& request) {
  require_plausible(request);
  const MutexLock lock(mutex_);
  return save_locked(request);
}

std::int64_t RecipeBook::save_locked(const RecipeSave& request) {
  const Recipe recipe = parsed_with_masks(request.text, request.id);
  const std::vector<std::string> ids = edited_ids(folders_.edited);
  const bool shadows = std::find(ids.begin(), ids.end(), request.id) != ids.end();
  RecipeVersion current;
  if (shadows) current = current_locked(request.id);
  if (current.version != request.base_version) {
    const std::string by = shadows ? ", saved by '" + current.author + "' at " + current.saved_utc : ", as shipped";
    throw Error(ErrorCode::kRecipeConflict,
                "recipe '" + request.id + "' is at version " + std::to_string(current.version) + by +
                    "; your text was made from version " + std::to_string(request.base_version) +
                    ": get the recipe anew, put your changes into it, and save that");
  }
  if (shadows && current.text == request.text) return current.version;
  if (!shadows && ids.size() >= static_cast<std::size_t>(kMaxEdited)) {
    throw Error(ErrorCode::kBadInput, "there are " + std::to_string(ids.size()) +
                                          " edited recipes, the most there may be; "
                                          "remove files that nobody needs from " +
                                          folders_.edited.string());
  }
  (void)make_directories(folders_.edited);
  const RecipeVersion wanted{.id = request.id,
                             .sha256 = recipe.sha256,
                             .author = request.author,
                             .comment = request.comment,
                             .text = request.text};
  const std::int64_t version = keep_locked(wanted);
  spdlog::info("recipe {}: version {} saved by '{}'", request.id, version, request.author);
  return version;
}

std::int64_t RecipeBook::keep_locked(const RecipeVersion& wanted) {
  write_next_recipe_text(folders_.edited, wanted.id, wanted.text);
  std::int64_t version = 0;
  try {
    version = versions_.add(wanted, kVersionsKept).version;
  } catch (...) {
    drop_next_recipe_text(folders_.edited, wanted.id);
    throw;
  }
  try {
    put_next_recipe_text_in_force(folders_.edited, wanted.id);
  } catch (...) {
    versions_.remove(wanted.id, version);  // where that fails too, the text waits until it can be put in force
    drop_next_recipe_text(folders_.edited, wanted.id);
    throw;
  }
  return version;
}

std::vector<RecipeVersion> RecipeBook::versions(const std::string& id) const {
  const MutexLock lock(mutex_);
  static_cast<void>(current_locked(id));
  return versions_.list(id);
}

std::int64_t RecipeBook::restore(const std::string& id, std::int64_t version, std::int64_t base_version,
                                 const std::string& author) {
  std::string text;
  if (version == 0) {
    const auto shipped = find_recipe_text(folders_.shipped, id);
    if (!shipped)
      throw Error(ErrorCode::kUnknownRecipe, "no recipe '" + id + "' was shipped; expected a version from 1");
    text = *shipped;
  } else {
    const auto found = versions_.find(id, version);
    if (!found) {
      throw Error(ErrorCode::kUnknownRecipe, "recipe '" + id + "' has no version " + std::to_string(version) +
                                                 "; recipe.versions tells those that are kept");
    }
    text = found->text;
  }
  return save({id, text, base_version, author, "version " + std::to_string(version) + " restored"});
}

}  // namespace fvd
