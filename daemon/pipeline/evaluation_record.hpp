#pragma once

/// A stored result evaluated by another recipe: a record of its own that names its source, which stays as it is.

#include <chrono>
#include <optional>
#include <string>

#include "core/runtime/worker_pool.hpp"
#include "core/surface/verdict.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/pipeline/stored_surface.hpp"
#include "daemon/recipes/recipe.hpp"

namespace fvd {

struct EvaluationRecordHead {
  std::string id;
  std::string software_version;                     ///< that evaluates
  std::chrono::system_clock::time_point evaluated;  ///< to 1 ms
};

struct EvaluationRecord {
  std::optional<Verdict> verdict;  ///< with that of the map, which the source's recipe limits
  std::string json;                ///< text of result.json
};

/// Evaluates the surface and puts result.json, and report.pdf unless the recipe does without, into the directory; does
/// not commit. result.json is the source's with recipe, evaluation, verdict and files of this record, and an object
/// "source" with the source's job_id, recipe, verdict, software version and the surface's SHA-256. pool may be null.
/// Throws Error kStorageFull, kStorageWrite, kInternal. context: thread-safe.
[[nodiscard]] EvaluationRecord write_evaluation_record(AtomicDirectory& directory, const StoredSurface& source,
                                                       const Recipe& recipe, const EvaluationRecordHead& head,
                                                       WorkerPool* pool);

}  // namespace fvd
