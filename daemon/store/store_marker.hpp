#pragma once

/// What is known of the database beside it, so that another one is never silently taken for it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "daemon/store/database.hpp"
#include "daemon/store/sequence_numbers.hpp"

namespace fvd {

/// As the last start, or a restoration, left it.
struct StoreMarker {
  std::int64_t epoch = 0;          ///< of the database; one of a lower epoch is an older copy
  NewestSeqs newest_seq;           ///< of each client
  std::int64_t margin = kSeqJump;  ///< so far behind may newest_seq be
  std::string file;                ///< which file the database was, see file_mark(); empty = not known
};

/// Tells a file from a copy of it: its inode and when that was made. Not the device: its number may be another one
/// after a reboot. Throws Error kDatabase.
[[nodiscard]] std::string file_mark(const std::filesystem::path& file);

/// "fvd.epoch" for "fvd.sqlite".
[[nodiscard]] std::filesystem::path marker_file(const std::filesystem::path& database);

/// Nothing where there is none. Throws Error kDatabase for a file that cannot be read as one.
[[nodiscard]] std::optional<StoreMarker> read_marker(const std::filesystem::path& database);

/// Durable at the return, the old one or the new one at any moment. Throws Error kStorageWrite, kStorageFull.
void write_marker(const std::filesystem::path& database, const StoreMarker& marker);

/// An older copy was put in the place of the database that the marker tells of, or another database. Throws Error
/// kDatabase for one that cannot be read.
[[nodiscard]] bool is_older(const Database& database, const StoreMarker& marker);

/// For people: which numbers are refused where nobody knows what was used since, and what a client does beyond them.
[[nodiscard]] std::string unknown_numbers_text(std::int64_t margin);

/// Throws Error kDatabase, with what to do, if the database is missing where there was one: its marker or results of
/// jobs are there.
void require_no_lost_database(const std::filesystem::path& database);

}  // namespace fvd
