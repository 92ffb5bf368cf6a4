#pragma once

/// Folders of results and rows of jobs, brought together after a process that was killed between the two.

#include <filesystem>
#include <string>

#include "daemon/store/job_store.hpp"

namespace fvd {

struct Reconciled {
  int adopted = 0;    ///< jobs that have their result now
  int removed = 0;    ///< folders that nobody was told of
  int set_aside = 0;  ///< whole results of jobs that were told without one
};

/// The folder of a job that this start found running becomes that job's result if it is whole. A job that was told
/// without a result stays so: a whole one of it, and one that a newer version wrote, is moved to the folder set-aside
/// beside `results`. What is not whole is removed; what cannot be read stays for the next start. Each is logged.
/// Folders of jobs and of evaluations that the database does not know stay. Throws Error kDatabase, kStorageFull.
/// context: before anybody is told of jobs.
Reconciled reconcile_results(JobStore& store, const std::filesystem::path& results);

/// Name of the hidden folder of an evaluation whose row the database refused. It ends in ".tmp": a start removes it.
[[nodiscard]] std::string refused_evaluation(const std::string& evaluation_id);

/// Gives back the folders of evaluations that were refused although the disk had their rows: those are told now.
/// context: at the start, before hidden folders are removed. Throws Error kDatabase; kStorageFull or kStorageWrite
/// where one cannot be renamed.
void restore_refused_evaluations(JobStore& store, const std::filesystem::path& results);

}  // namespace fvd
