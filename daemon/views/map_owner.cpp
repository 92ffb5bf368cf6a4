#include "daemon/views/map_owner.hpp"

#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
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

void require_kept(const StoredJob& stored, MapCache& maps) {
  try {
    require_not_removed(stored.status);
  } catch (const Error&) {
    maps.forget(stored.status.job_id);
    maps.forget(source_of(stored.result_json));  // an evaluation is removed with its source, whose maps are open
    throw;
  }
}

}  // namespace

std::optional<StoredJob> map_owner(const ResultService& results, const std::string& id, MapCache& maps) {
  StoredJob stored = results.stored(id);
  require_kept(stored, maps);
  if (stored.result_dir.empty() || stored.result_json.empty()) return std::nullopt;
  if (!heights_file(stored.result_dir).empty()) return stored;
  const std::string source = source_of(stored.result_json);
  if (source.empty() || source == id) return stored;
  stored = results.stored(source);
  require_kept(stored, maps);
  if (stored.result_dir.empty() || stored.result_json.empty()) return std::nullopt;
  return stored;
}

}  // namespace fvd
