#include "daemon/store/recipe_table.hpp"

namespace fvd {

namespace {

#define FVD_RECIPE_COLUMNS "recipe, version, sha256, author, comment, saved_utc"

RecipeVersion read_row(const Statement& row) {
  return {.id = row.text(0),
          .version = row.integer(1),
          .sha256 = row.text(2),
          .author = row.text(3),
          .comment = row.text(4),
          .saved_utc = row.text(5)};
}

std::optional<RecipeVersion> first_row_with_text(Statement& rows) {
  if (!rows.step()) return std::nullopt;
  RecipeVersion version = read_row(rows);
  version.text = rows.text(6);
  return version;
}

std::optional<RecipeVersion> latest_in(const Database& database, const std::string& id) {
  Statement rows(database, "SELECT " FVD_RECIPE_COLUMNS
                           ", document FROM recipe_versions WHERE recipe = ? ORDER BY version DESC LIMIT 1");
  rows.bind(id);
  return first_row_with_text(rows);
}

}  // namespace

std::vector<RecipeVersion> RecipeTable::list(const std::string& id) const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT " FVD_RECIPE_COLUMNS " FROM recipe_versions WHERE recipe = ? ORDER BY version DESC");
  rows.bind(id);
  std::vector<RecipeVersion> versions;
  while (rows.step()) versions.push_back(read_row(rows));
  return versions;
}

std::optional<RecipeVersion> RecipeTable::find(const std::string& id, std::int64_t version) const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT " FVD_RECIPE_COLUMNS ", document FROM recipe_versions WHERE recipe = ? AND version = ?");
  rows.bind(id).bind(version);
  return first_row_with_text(rows);
}

std::optional<RecipeVersion> RecipeTable::latest(const std::string& id) const {
  const MutexLock lock(reader_.mutex);
  return latest_in(reader_.database, id);
}

RecipeVersion RecipeTable::add(const RecipeVersion& version, int kept) {
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  const auto newest = latest_in(writer_.database, version.id);
  const std::int64_t number = newest ? newest->version + 1 : 1;
  Statement(writer_.database,
            "INSERT INTO recipe_versions (recipe, version, sha256, author, comment, document) "
            "VALUES (?, ?, ?, ?, ?, ?)")
      .bind(version.id)
      .bind(number)
      .bind(version.sha256)
      .bind(version.author)
      .bind(version.comment)
      .bind(version.text)
      .run();
  Statement(writer_.database, "DELETE FROM recipe_versions WHERE recipe = ? AND version <= ?")
      .bind(version.id)
      .bind(number - kept)
      .run();
  RecipeVersion added = latest_in(writer_.database, version.id).value();
  transaction.commit();
  return added;
}

void RecipeTable::remove(const std::string& id, std::int64_t version) {
  const MutexLock lock(writer_.mutex);
  Statement(writer_.database, "DELETE FROM recipe_versions WHERE recipe = ? AND version = ?")
      .bind(id)
      .bind(version)
      .run();
}

}  // namespace fvd
