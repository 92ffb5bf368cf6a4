#pragma once

/// The tables of the job database, version by version: a file of any older version is brought up to date step by step.

#include <span>
#include <string_view>

#include "daemon/store/database.hpp"

namespace fvd {

/// Leads from one version to the next; version 0 is an empty file.
struct MigrationStep {
  std::string_view what;   ///< what the new version has, for the log
  void (*run)(Database&);  ///< throws Error; called inside a transaction
};

/// Step i leads from version i to i + 1. A released step never changes: files in the field were written by it.
[[nodiscard]] std::span<const MigrationStep> migration_steps();

/// The version that this program reads and writes, kept in PRAGMA user_version.
[[nodiscard]] int newest_schema_version();
[[nodiscard]] int schema_version(const Database& database);

/// Takes the file from its version to `version`, each step in a transaction of its own: a step that fails leaves the
/// version before it with all its rows. A copy of the file as it was found is kept beside it, as "<file>.v<version>".
/// Throws Error kDatabase if a newer fvd or another program made the file, kStorageFull.
void migrate(Database& database, int version = newest_schema_version());

}  // namespace fvd
