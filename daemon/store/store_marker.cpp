#include "daemon/store/store_marker.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

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

std::string file_mark(const fs::path& file) {
  struct statx info {};
  if (::statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_BTIME, &info) != 0) {
    throw Error(ErrorCode::kDatabase, "cannot look at " + file.string() + ": " + std::strerror(errno));
  }
  std::string mark = std::to_string(info.stx_ino);
  // Inodes of deleted files are given again at once; some file systems do not know when one was made.
  if ((info.stx_mask & STATX_BTIME) != 0) {
    mark += "." + std::to_string(info.stx_btime.tv_sec) + "." + std::to_string(info.stx_btime.tv_nsec);
  }
  return mark;
}

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
    marker.file = json.value("file", std::string());
    return marker;
  } catch (const std::exception& problem) {
    throw Error(ErrorCode::kDatabase, file.string() + " cannot be read: " + problem.what() +
                                          ": it keeps an older database from being taken for the newest; delete it "
                                          "only if nobody put another database here");
  }
}

void write_marker(const fs::path& database, const StoreMarker& marker) {
  const nlohmann::ordered_json json{
      {"epoch", marker.epoch}, {"newest_seq", marker.newest_seq}, {"margin", marker.margin}, {"file", marker.file}};
  replace_file(marker_file(database), [text = json.dump() + "\n"](const ByteSink& sink) { sink(text); });
}

bool is_older(const Database& database, const StoreMarker& marker) {
  if (marker.epoch > scalar(database, "SELECT epoch FROM starts")) return true;
  if (!marker.file.empty() && marker.file != file_mark(database.file())) return true;  // a copy of the same epoch
  const NewestSeqs newest = newest_seqs_in(database);
  return std::any_of(marker.newest_seq.begin(), marker.newest_seq.end(), [&newest](const auto& noted) {
    const auto known = newest.find(noted.first);
    return known == newest.end() || known->second < noted.second;
  });
}

std::string unknown_numbers_text(std::int64_t margin) {
  return "which numbers were used since is not known here: of each client those up to " + std::to_string(margin) +
         " above its newest that is known are not run again; a client that may have used higher ones goes on behind "
         "its own highest";
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
