#include "daemon/store/job_schema.hpp"

#include "core/base/error.hpp"

namespace fvd {

namespace {

// States and errors are stored by name: names are the stable contract, numbers of enumerators are not.
constexpr const char* kVersion1 = R"(
CREATE TABLE starts (
  epoch INTEGER NOT NULL
) STRICT;
INSERT INTO starts (epoch) VALUES (0);
CREATE TABLE jobs (
  number            INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id            TEXT    NOT NULL UNIQUE,
  seq               INTEGER NOT NULL UNIQUE,
  part_id           TEXT    NOT NULL,
  recipe            TEXT    NOT NULL,
  state             TEXT    NOT NULL,
  error             TEXT    NOT NULL DEFAULT '',
  error_message     TEXT    NOT NULL DEFAULT '',
  acknowledged      INTEGER NOT NULL DEFAULT 0,
  slices_done       INTEGER NOT NULL DEFAULT 0,
  slices_planned    INTEGER NOT NULL DEFAULT 0,
  frames_expected   INTEGER NOT NULL DEFAULT 0,
  frames_ok         INTEGER NOT NULL DEFAULT 0,
  frames_incomplete INTEGER NOT NULL DEFAULT 0,
  frames_missing    INTEGER NOT NULL DEFAULT 0,
  frames_stale      INTEGER NOT NULL DEFAULT 0,
  frames_underrun   INTEGER NOT NULL DEFAULT 0,
  created_utc       TEXT    NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  ended_utc         TEXT    NOT NULL DEFAULT '',
  result_dir        TEXT    NOT NULL DEFAULT '',
  result_json       TEXT    NOT NULL DEFAULT ''
) STRICT;
CREATE INDEX jobs_waiting ON jobs (number) WHERE acknowledged = 0;
PRAGMA user_version = 1;
)";

}  // namespace

void prepare_job_schema(Database& database) {
  Transaction transaction(database);
  std::int64_t version = 0;
  {
    Statement query(database, "PRAGMA user_version");
    if (query.step()) version = query.integer(0);
  }
  if (version > kJobSchemaVersion) {
    throw Error(ErrorCode::kDatabase, "database " + database.file().string() + " has version " +
                                          std::to_string(version) + ", this fvd knows versions up to " +
                                          std::to_string(kJobSchemaVersion) + ": install the newer fvd that wrote it");
  }
  if (version == 0) database.execute(kVersion1);
  transaction.commit();
}

}  // namespace fvd
