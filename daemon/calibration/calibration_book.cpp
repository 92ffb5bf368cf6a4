#include "daemon/calibration/calibration_book.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/json_values.hpp"

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
  fields.list("versions", document.versions, {0, kMostVersions}, "in the order in which they were accepted",
              [](Fields& in, Calibration& version) { describe(version, in); });
}

std::vector<Calibration> read_versions(const fs::path& file) {
  if (!fs::exists(file)) return {};
  Document document;
  Problems problems;
  read_document(
      read_text_file(file), [&document](Fields& fields) { describe(document, fields); }, problems);
  if (!problems.empty()) {
    throw Error(ErrorCode::kBadInput, file.string() + ": " + problems.front().pointer + ": " +
                                          problems.front().message + "; put back the file of the last backup");
  }
  return std::move(document.versions);
}

/// In place of the old file as a whole: a power cut leaves the one or the other.
void write_versions(const fs::path& folder, Document document) {
  const std::string text = fields_to_json([&document](Fields& fields) { describe(document, fields); }).dump(2) + "\n";
  const fs::path next = folder / (std::string(kFileName) + ".new");
  std::error_code error;
  fs::remove(next, error);  // of a process that died while it wrote
  write_new_file(next, text);
  fs::rename(next, folder / kFileName, error);
  if (error) {
    throw Error(ErrorCode::kStorageWrite, "cannot replace " + (folder / kFileName).string() + ": " + error.message());
  }
  sync_directory(folder);
}

std::string id_of(std::size_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "cal-%04zu", number);
  return text;
}

}  // namespace

CalibrationBook::CalibrationBook(fs::path folder)
    : folder_(std::move(folder)), versions_(read_versions(folder_ / kFileName)) {}

std::optional<Calibration> CalibrationBook::current(const std::string& objective) const {
  MutexLock lock(mutex_);
  const auto newest = std::find_if(versions_.rbegin(), versions_.rend(),
                                   [&](const Calibration& version) { return version.objective == objective; });
  if (newest == versions_.rend()) return std::nullopt;
  return *newest;
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
  Calibration next = current(objective).value_or(Calibration{});
  MutexLock lock(mutex_);
  next.id = id_of(versions_.size() + 1);
  next.objective = objective;
  next.created = iso8601_utc(std::chrono::system_clock::now());
  const std::vector<CalibrationFile> files = change(next);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw Error(ErrorCode::kStorageWrite, "cannot make " + folder_.string() + ": " + error.message());
  for (const CalibrationFile& file : files) {
    fs::remove(folder_ / file.name, error);  // of a version that never came to be
    write_new_file(folder_ / file.name, file.bytes);
  }
  Document document;
  document.versions = versions_;
  document.versions.push_back(next);
  write_versions(folder_, std::move(document));
  versions_.push_back(next);
  return next;
}

}  // namespace fvd
