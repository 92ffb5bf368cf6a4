#pragma once

/// Folders of results and rows of jobs, brought together after a process that was killed between the two.

#include <filesystem>

#include "daemon/store/job_store.hpp"

namespace fvd {

struct Reconciled {
  int adopted = 0;    ///< jobs that have their result now
  int removed = 0;    ///< folders that nobody was told of
  int set_aside = 0;  ///< whole results of jobs that were told without one
};

/// The folder of a job that this start found running becomes that job's result if it is whole. A job that was told
/// without a result stays so: a whole one of it is moved to the folder set-aside beside `results`. What is not whole is
/// removed; what cannot be read stays for the next start. Each is logged. Folders of jobs and of evaluations that the
/// database does not know stay. Throws Error kDatabase, kStorageFull. context: before anybody is told of jobs.
Reconciled reconcile_results(JobStore& store, const std::filesystem::path& results);

}  // namespace fvd
