#pragma once

/// From what a job acquired to its result on disk.

#include <functional>
#include <optional>
#include <string>

#include "core/base/error.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/result/result_data.hpp"

namespace fvd {

struct JobResult {
  std::string directory;           ///< with its files, durable
  std::string text;                ///< of result.json
  std::optional<ErrorCode> error;  ///< why the job failed though it has a result: too few points are valid
  std::string message;
};

/// Gives a job's result for what it acquired, in a directory that may hold recorded slices already. Throws Error
/// kStorageFull, kStorageWrite; nothing of the directory is left then.
using ResultPipeline = std::function<JobResult(AtomicDirectory& directory, const ResultData& acquired)>;

/// Judges, writes the files, commits the directory.
[[nodiscard]] JobResult store_result(AtomicDirectory& directory, const ResultData& acquired);

}  // namespace fvd
