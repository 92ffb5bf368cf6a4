#pragma once

/// Whose maps are shown where an id is asked for.

#include <optional>
#include <string>

#include "daemon/jobs/services.hpp"
#include "daemon/views/map_cache.hpp"

namespace fvd {

/// The job of that id with its result; for an evaluation, which has no maps, the job whose surface was evaluated.
/// Nothing where the job has no result. Throws Error kUnknownJob, kDatabase; kResultRemoved, and then `maps` keeps
/// nothing of it open. context: as ResultService.
[[nodiscard]] std::optional<StoredJob> map_owner(const ResultService& results, const std::string& id, MapCache& maps);

}  // namespace fvd
