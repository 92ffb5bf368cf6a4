#include "daemon/store/sequence_numbers.hpp"

#include <algorithm>
#include <sstream>

#include "core/base/error.hpp"

namespace fvd {

namespace {

std::string temperature_text(const std::optional<double>& temperature_c) {
  if (!temperature_c) return {};
  std::ostringstream text;
  text << ", temperature_c " << *temperature_c;
  return text.str();
}

std::int64_t newest_of(const Database& database, const std::string& client) {
  Statement highest(database,
                    "SELECT max(coalesce((SELECT max(seq) FROM jobs WHERE client = ?), 0), "
                    "coalesce((SELECT seq FROM seq_floors WHERE client = ?), 0))");
  highest.bind(client).bind(client);
  return highest.step() ? highest.integer(0) : 0;
}

void require_new(const JobRequest& request, std::int64_t newest) {
  const std::string number = number_text(request.seq, request.client);
  const std::string go_on = ": continue with " + std::to_string(newest + 1);
  if (request.seq < newest - kSeqWindow) {
    throw Error(ErrorCode::kSeqStale, number + " is more than " + std::to_string(kSeqWindow) + " behind the newest, " +
                                          std::to_string(newest) + go_on);
  }
  if (newest > 0 && request.seq > newest + kSeqJump) {
    throw Error(ErrorCode::kSeqStale, number + " is more than " + std::to_string(kSeqJump) + " ahead of the newest, " +
                                          std::to_string(newest) + ", and would use up all numbers in between" + go_on);
  }
}

/// The floor that a restored database has: numbers up to it may have moved the stage.
void require_above_floor(const Database& database, const JobRequest& request) {
  Statement floor(database, "SELECT seq FROM seq_floors WHERE client = ?");
  floor.bind(request.client);
  if (!floor.step() || request.seq > floor.integer(0)) return;
  throw Error(ErrorCode::kSeqStale, number_text(request.seq, request.client) +
                                        " may have been used before the database was restored or made anew: continue "
                                        "with " +
                                        std::to_string(newest_of(database, request.client) + 1));
}

void require_same(const JobStatus& known, const JobRequest& request) {
  const bool same_recipe = request.recipe.empty() || request.recipe == known.request.recipe;
  const bool same_temperature = request.temperature_c == known.request.temperature_c;
  const std::string number = number_text(request.seq, request.client);
  if (known.request.part_id != request.part_id || !same_recipe || !same_temperature) {
    throw Error(ErrorCode::kSeqConflict, number + " belongs to job " + known.job_id + " (part '" +
                                             known.request.part_id + "', recipe '" + known.request.recipe + "'" +
                                             temperature_text(known.request.temperature_c) +
                                             "): use a new number for a new job");
  }
  if (known.request.session != request.session) {
    throw Error(ErrorCode::kSeqConflict, number + " belongs to job " + known.job_id + " of session '" +
                                             known.request.session + "', this is session '" + request.session +
                                             "': use a new number for a new job");
  }
}

/// An old result must not be taken for that of a part that came since.
void require_recent(const JobStatus& known, const JobRequest& request, std::chrono::seconds window,
                    std::int64_t newest) {
  const std::int64_t age_s = seconds_since(known.ended_utc);
  if (known.state == JobState::kProcessing || age_s <= window.count()) return;
  throw Error(ErrorCode::kSeqStale, number_text(request.seq, request.client) + " belongs to job " + known.job_id +
                                        ", which ended " + std::to_string(age_s) + " s ago, longer than " +
                                        std::to_string(window.count()) + " s (rpc.repeat_window_s): ask result.get " +
                                        "for its result; a new part takes " + std::to_string(newest + 1));
}

}  // namespace

NewestSeqs newest_seqs_in(const Database& database) {
  Statement rows(database,
                 "SELECT client, max(seq) FROM (SELECT client, seq FROM jobs UNION ALL "
                 "SELECT client, seq FROM seq_floors) GROUP BY client");
  NewestSeqs newest;
  while (rows.step()) newest[rows.text(0)] = rows.integer(1);
  return newest;
}

bool is_surely_new(const NewestSeqs& newest, const JobRequest& request) {
  const auto known = newest.find(request.client);
  return known == newest.end() || (request.seq > known->second && request.seq <= known->second + kSeqJump);
}

void raise_seq_floors(Database& database, const NewestSeqs& newest, std::int64_t margin) {
  for (const auto& [client, seq] : newest) {
    Statement(database,
              "INSERT INTO seq_floors (client, seq) VALUES (?, ?) "
              "ON CONFLICT (client) DO UPDATE SET seq = max(seq, excluded.seq)")
        .bind(client)
        .bind(std::min(seq + margin, kLargestSeq))
        .run();
  }
}

std::optional<JobStatus> repeated_in(const Database& database, const KeptEnds& kept, const JobRequest& request,
                                     std::chrono::seconds repeat_window) {
  Statement query(database, "SELECT " FVD_JOB_COLUMNS " FROM jobs WHERE client = ? AND seq = ?");
  query.bind(request.client).bind(request.seq);
  auto known = first_status(query, kept);
  const std::int64_t newest = newest_of(database, request.client);
  if (!known) {
    require_above_floor(database, request);
    require_new(request, newest);
    return std::nullopt;
  }
  require_same(*known, request);
  require_recent(*known, request, repeat_window, newest);
  return known;
}

}  // namespace fvd
