#pragma once

/// From what a job acquired to its result on disk.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "daemon/export/atomic_directory.hpp"
#include "daemon/export/result_writer.hpp"
#include "daemon/result/result_data.hpp"
#include "daemon/store/stored_value.hpp"

namespace fvd {

struct JobResult {
  std::string directory;              ///< with the files that a verdict waits for, durable
  std::string text;                   ///< of result.json
  bool files_pending = false;         ///< the others follow, and the digests
  std::vector<WrittenBytes> written;  ///< what the digests are made of
  std::optional<ErrorCode> error;     ///< why the job failed though it has a result: too few points are valid
  std::string message;
  std::string verdict;              ///< as JobStatus
  std::string reason_codes;         ///< likewise
  std::vector<StoredValue> values;  ///< for the job database
};

/// Notes what the result says of the part.
void note_verdict(const Result& result, std::string& verdict, std::string& reason_codes);

/// Gives a job's result for what it acquired, in a directory that may hold recorded slices already. begun: its files
/// where they are on their way already, else null. Throws Error kStorageFull, kStorageWrite; nothing of the directory
/// is left then.
using ResultPipeline =
    std::function<JobResult(AtomicDirectory& directory, const ResultData& acquired, FirstFilesWriter* begun)>;

/// Judges, writes the files that a verdict waits for, commits the directory.
[[nodiscard]] JobResult store_result(AtomicDirectory& directory, const ResultData& acquired,
                                     FirstFilesWriter* begun = nullptr);

}  // namespace fvd
