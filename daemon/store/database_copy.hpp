#pragma once

/// A copy of a database that may be in use.

#include <filesystem>

#include "daemon/store/database.hpp"

namespace fvd {

/// Copies what is committed into a new file, whole and durable at the return, in place of one of that name. Writers of
/// the source go on meanwhile. Throws Error kDatabase, kStorageFull, kStorageWrite; the copy is not there then.
void copy_database(const Database& source, const std::filesystem::path& copy);

/// The same from a database that another process has open, or none.
void copy_database_in_use(const std::filesystem::path& source, const std::filesystem::path& copy);

}  // namespace fvd
