#pragma once

/// Which sequence numbers a client may use, and what a repeated one means.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "daemon/store/database.hpp"
#include "daemon/store/job_rows.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// An unknown number that is further back than this from its client's newest is refused as stale.
inline constexpr std::int64_t kSeqWindow = 1000;
/// One that is further ahead is refused: a typing error would use up all numbers below it.
inline constexpr std::int64_t kSeqJump = 10000;

inline constexpr std::int64_t kLargestSeq = (std::int64_t{1} << 53U) - 1;

/// The newest number of each client: that of a job, or the floor that a restored or lost database left.
using NewestSeqs = std::map<std::string, std::int64_t>;
[[nodiscard]] NewestSeqs newest_seqs_in(const Database& database);

/// Whether the number is above its client's newest, and not too far: then no job of it is known. The usual trigger of a
/// line, whose database need not be read for that.
[[nodiscard]] bool is_surely_new(const NewestSeqs& newest, const JobRequest& request);

/// Counts all numbers up to `newest_seq + margin` of each client as used, whatever jobs are known.
void raise_seq_floors(Database& database, const NewestSeqs& newest, std::int64_t margin);

/// The job that the request repeats: same part, temperature, session and recipe (one that names no recipe repeats
/// whichever was taken). Nothing if the number is new. Throws Error kSeqConflict if the number belongs to another
/// request, kSeqStale if its job ended longer than repeat_window ago, or if it is unknown and too far back or
/// ahead.
[[nodiscard]] std::optional<JobStatus> repeated_in(const Database& database, const KeptEnds& kept,
                                                   const JobRequest& request, std::chrono::seconds repeat_window);

}  // namespace fvd
