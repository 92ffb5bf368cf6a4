#include "daemon/store/store_marker.hpp"

#include <string>
#include <system_error>

#include <nlohmann/json.hpp>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/replace_file.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

bool has_results(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!entry->path().filename().string().starts_with('.')) return true;
  }
  return false;
}

}  // namespace

fs::path marker_file(const fs::path& database) { return fs::path(database).replace_extension(".epoch"); }

std::optional<StoreMarker> read_marker(const fs::path& database) {
  const fs::path file = marker_file(database);
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    const auto json = nlohmann::json::parse(read_text_file(file));
    StoreMarker marker;
    marker.epoch = json.at("epoch").get<std::int64_t>();
    marker.newest_seq = json.at("newest_seq").get<NewestSeqs>();
    marker.margin = json.at("margin").get<std::int64_t>();
    return marker;
  } catch (const std::exception& problem) {
    throw Error(ErrorCode::kDatabase, file.string() + " cannot be read: " + problem.what() +
                                          ": it keeps an older database from being taken for the newest; delete it "
                                          "only if nobody put another database here");
  }
}

void write_marker(const fs::path& database, const StoreMarker& marker) {
  const nlohmann::ordered_json json{
      {"epoch", marker.epoch}, {"newest_seq", marker.newest_seq}, {"margin", marker.margin}};
  replace_file(marker_file(database), [text = json.dump() + "\n"](const ByteSink& sink) { sink(text); });
}

void require_no_lost_database(const fs::path& database) {
  std::error_code error;
  if (fs::exists(database, error) && fs::file_size(database, error) > 0) return;
  const fs::path results = fs::absolute(database).parent_path() / "results";
  const bool marked = fs::exists(marker_file(database), error);
  if (!marked && !has_results(results)) return;
  throw Error(ErrorCode::kDatabase,
              "the database " + database.string() + " is gone, but " +
                  (marked ? marker_file(database).string() : results.string()) +
                  " says that there was one: put it back, or a backup by fvdctl restore; fvd --new-database starts "
                  "without it, and then no job of before is known");
}

}  // namespace fvd
