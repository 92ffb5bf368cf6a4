#pragma once

/// A copy of a database that may be in use.

#include <filesystem>
#include <string>

#include "daemon/store/database.hpp"

namespace fvd {

/// Copies what is committed into a new file, whole and durable at the return, in place of one of that name. Writers of
/// the source go on meanwhile. Throws Error kDatabase, kStorageFull, kStorageWrite; the copy is not there then.
void copy_database(const Database& source, const std::filesystem::path& copy);

/// The same from a database that another process has open, or none.
void copy_database_in_use(const std::filesystem::path& source, const std::filesystem::path& copy);

/// Of the jobs that run in a copy: the start that ends them says that the copy was made meanwhile, and when, in place
/// of its own moment. What was noted before stays. Of any version of the tables. Throws Error kDatabase, kStorageFull.
void note_running_jobs(Database& copy, const std::string& copied_utc);

}  // namespace fvd
