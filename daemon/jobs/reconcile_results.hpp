#pragma once

/// Folders of results and rows of jobs, brought together after a process that was killed between the two.

#include <filesystem>

#include "daemon/store/job_store.hpp"

namespace fvd {

struct Reconciled {
  int adopted = 0;  ///< jobs that have their result now
  int removed = 0;  ///< folders that nobody was told of
};

/// A folder whose job has no end becomes that job's result if it is whole, else it is removed. Each is logged. Folders
/// of jobs and of evaluations that the database does not know stay. Throws Error kDatabase, kStorageFull.
/// context: before anybody is told of jobs.
Reconciled reconcile_results(JobStore& store, const std::filesystem::path& results);

}  // namespace fvd
