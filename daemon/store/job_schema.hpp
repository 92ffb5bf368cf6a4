#pragma once

/// Tables of the job database and how they came to be, version by version.

#include "daemon/store/database.hpp"

namespace fvd {

/// Version of the tables that this program reads and writes, kept in PRAGMA user_version.
inline constexpr int kJobSchemaVersion = 1;

/// Creates the tables in an empty database. Throws Error kDatabase if a newer version made them.
void prepare_job_schema(Database& database);

}  // namespace fvd
