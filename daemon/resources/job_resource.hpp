#pragma once

/// Maps and files of stored results: /api/v1/jobs/ID/height and /api/v1/jobs/ID/files/NAME.

#include <string>
#include <string_view>

#include "daemon/jobs/services.hpp"
#include "daemon/transport/http_resource.hpp"
#include "daemon/views/map_cache.hpp"

namespace fvd {

/// The path below which it is mounted.
inline constexpr const char* kJobsPath = "/api/v1/jobs/";

/// Whatever is sent belongs to a job that the database knows; names of files come from its record alone. Answers have
/// strong entity tags; a map never changes and is kept by browsers for ever. context: thread-safe; reads the database
/// and files.
class JobResource final : public HttpResource {
 public:
  /// results outlives it.
  explicit JobResource(const ResultService& results) : results_(results) {}

  [[nodiscard]] ResourceAnswer get(const ResourceRequest& request) override;

 private:
  [[nodiscard]] ResourceAnswer height(const std::string& id, const ResourceRequest& request);
  [[nodiscard]] ResourceAnswer file(const std::string& id, std::string_view name, const ResourceRequest& request) const;

  const ResultService& results_;
  MapCache maps_;
};

}  // namespace fvd
