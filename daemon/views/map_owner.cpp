#include "daemon/views/map_owner.hpp"

#include <nlohmann/json.hpp>

#include "daemon/surface_files/result_folder.hpp"

namespace fvd {

namespace {

/// The job that an evaluation names; empty in the record of a job.
std::string source_of(const std::string& record) {
  const nlohmann::json document = nlohmann::json::parse(record, nullptr, false);
  const auto source = nlohmann::json::json_pointer("/source/job_id");
  if (!document.is_object() || !document.contains(source) || !document[source].is_string()) return {};
  return document[source].get<std::string>();
}

}  // namespace

std::optional<StoredJob> map_owner(const ResultService& results, const std::string& id) {
  StoredJob stored = results.stored(id);
  require_not_removed(stored.status);
  if (stored.result_dir.empty() || stored.result_json.empty()) return std::nullopt;
  if (!heights_file(stored.result_dir).empty()) return stored;
  const std::string source = source_of(stored.result_json);
  if (source.empty() || source == id) return stored;
  stored = results.stored(source);
  require_not_removed(stored.status);
  if (stored.result_dir.empty() || stored.result_json.empty()) return std::nullopt;
  return stored;
}

}  // namespace fvd
