#include "daemon/calibration/calibration_book.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/json_values.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "calibration.json";
constexpr int kFormat = 1;
constexpr std::int64_t kMostVersions = 100000;

struct Document {
  int format = kFormat;
  std::vector<Calibration> versions;
};

void describe(Document& document, Fields& fields) {
  fields.integer("format", document.format, {kFormat, kFormat}, "of this file");
  fields.require("format");
  fields.list("versions", document.versions, {0, kMostVersions}, "in the order in which they were accepted",
              [](Fields& in, Calibration& version) { describe(version, in); });
  fields.require("versions");
}

std::string id_of(std::size_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "cal-%04zu", number);
  return text;
}

/// Versions are never taken out, so that a number that is missing or there twice is damage.
void check_ids(const std::vector<Calibration>& versions, Problems& problems) {
  for (std::size_t i = 0; i < versions.size(); ++i) {
    if (versions[i].id == id_of(i + 1)) continue;
    problems.push_back({"/versions/" + std::to_string(i) + "/id",
                        "\"" + versions[i].id + "\" is not " + id_of(i + 1) + ", which comes next"});
    return;
  }
}

/// What the text says; problems where it is not what this program writes.
std::vector<Calibration> versions_in(const std::string& text, Problems& problems) {
  Document document;
  read_document(
      text, [&document](Fields& fields) { describe(document, fields); }, problems);
  if (problems.empty()) check_ids(document.versions, problems);
  return std::move(document.versions);
}

std::vector<Calibration> read_versions(const fs::path& file) {
  std::error_code error;
  const bool is_there = fs::exists(file, error);
  if (error) throw Error(ErrorCode::kBadInput, "cannot look at " + file.string() + ": " + error.message());
  if (!is_there) return {};
  Problems problems;
  std::vector<Calibration> versions = versions_in(read_text_file(file, kAnyLength), problems);
  if (!problems.empty()) {
    throw Error(ErrorCode::kBadInput, file.string() + ": " + problems.front().pointer + ": " +
                                          problems.front().message + "; put back the file of the last backup");
  }
  return versions;
}

/// Constants that could not be read back must not get into the file.
std::string checked_text(std::vector<Calibration> versions) {
  Document document;
  document.versions = std::move(versions);
  std::string text = fields_to_json([&document](Fields& fields) { describe(document, fields); }).dump(2) + "\n";
  Problems problems;
  (void)versions_in(text, problems);
  if (problems.empty()) return text;
  throw Error(ErrorCode::kBadInput,
              "these constants cannot be kept: " + problems.front().pointer + ": " + problems.front().message);
}

/// In place of the old file as a whole: a power cut leaves the one or the other. The folder is still to be flushed.
void put_in_force(const fs::path& folder, const std::string& text) {
  const fs::path next = folder / (std::string(kFileName) + ".new");
  remove_file(next);  // of a process that died while it wrote
  write_new_file(next, text);
  if (file_calls().rename(next, folder / kFileName) == 0) return;
  const int reason = errno;
  file_calls().unlink(next);
  throw storage_error(reason, "replace", folder / kFileName);
}

}  // namespace

CalibrationBook::CalibrationBook(fs::path folder)
    : folder_(std::move(folder)), versions_(read_versions(folder_ / kFileName)) {}

std::optional<Calibration> CalibrationBook::current(const std::string& objective) const {
  MutexLock lock(mutex_);
  return newest(objective);
}

std::optional<Calibration> CalibrationBook::newest(const std::string& objective) const {
  const auto found = std::find_if(versions_.rbegin(), versions_.rend(),
                                  [&](const Calibration& version) { return version.objective == objective; });
  if (found == versions_.rend()) return std::nullopt;
  return *found;
}

std::optional<Calibration> CalibrationBook::find(const std::string& id) const {
  MutexLock lock(mutex_);
  const auto found =
      std::find_if(versions_.begin(), versions_.end(), [&](const Calibration& version) { return version.id == id; });
  if (found == versions_.end()) return std::nullopt;
  return *found;
}

std::vector<Calibration> CalibrationBook::versions() const {
  MutexLock lock(mutex_);
  return versions_;
}

Calibration CalibrationBook::add(const std::string& objective,
                                 const std::function<std::vector<CalibrationFile>(Calibration& next)>& change) {
  const MutexLock adding(adding_);
  std::vector<Calibration> all = versions();
  Calibration next = current(objective).value_or(Calibration{});
  next.id = id_of(all.size() + 1);
  next.objective = objective;
  next.created = iso8601_utc(std::chrono::system_clock::now());
  const std::vector<CalibrationFile> files = change(next);
  all.push_back(next);
  const std::string text = checked_text(all);
  if (make_directories(folder_)) sync_directory(fs::absolute(folder_).parent_path());
  for (const CalibrationFile& file : files) {
    assert(file.name.starts_with(next.id) && file.name.find('/') == std::string::npos);
    remove_file(folder_ / file.name);  // of a version that never came to be
    write_new_file(folder_ / file.name, file.bytes);
  }
  put_in_force(folder_, text);
  // From here on the file has the version: its number must not be given again, whatever comes of the flush.
  keep(next);
  sync_directory(folder_);
  return next;
}

void CalibrationBook::keep(const Calibration& next) {
  const MutexLock lock(mutex_);
  versions_.push_back(next);
}

}  // namespace fvd
