#pragma once

/// Jobs from the newest on, and how a value went from job to job: what the job database tells in lists.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/store/database.hpp"
#include "daemon/store/job_rows.hpp"
#include "daemon/store/job_status.hpp"

namespace fvd {

/// Which jobs are meant; what is empty or absent leaves no job out.
struct JobFilter {
  std::string part_id{};                 ///< the part's id begins so
  std::string recipe{};                  ///< its id
  std::optional<std::string> verdict{};  ///< as JobStatus; empty = nothing was judged
  std::optional<JobState> state{};
  std::string from_utc{};  ///< ended then or later, as JobStatus::ended_utc; a job that has not ended is left out
  std::string to_utc{};    ///< ended then or before; likewise
  std::string text{};  ///< stands in the job's id, part, recipe, client, state or error; ASCII letters in either case
};

/// A part of a list of jobs, the newest first.
struct JobPage {
  std::vector<JobStatus> jobs{};  ///< of each what a list tells: id, request without session and temperature, state,
                                  ///< verdict, ended_utc, error
  std::int64_t next = 0;  ///< `before` of the part that follows; 0 = there is none, every older job was looked at
};

struct ValueQuery {
  std::string measurement{};
  std::string value{};   ///< its name
  std::string recipe{};  ///< only of jobs of this recipe; empty = of all
  int most = 100;        ///< so many of the newest jobs that have it
};

/// A value in one job; see ValueList.
struct ValuePoint {
  std::string job_id;
  std::string part_id;
  std::string ended_utc;
  StoredValue value;
};

struct ValueList {
  std::vector<ValuePoint> points{};  ///< the oldest first
  bool searched_all = true;          ///< false = fewer than were asked for, and older jobs were not looked at
};

/// Reads on a connection of its own: a long list keeps no other reader waiting, and a commit neither.
/// context: thread-safe; blocks for the disk, and for other lists.
class JobHistory {
 public:
  /// Jobs that one call looks at, so that what nearly no job has, or none, is not sought through years.
  static constexpr std::int64_t kMostLookedAt = 20'000;

  struct Connection {
    Database& database;
    Mutex& mutex;  ///< guards it
  };
  /// What it refers to outlives the history. kept: the ends that the database does not have yet.
  JobHistory(Connection reader, std::function<KeptEnds()> kept) : reader_(reader), kept_(std::move(kept)) {}

  /// At most so many jobs that fit the filter, the newest first; fewer, or none, where no more of kMostLookedAt do:
  /// then `next` tells that the list goes on. before: JobPage::next of the part before; 0 = from the newest on. Jobs
  /// that come meanwhile change nothing in the parts that follow. Throws Error kDatabase.
  [[nodiscard]] JobPage page(const JobFilter& filter, std::int64_t before, int most) const;

  /// Of the newest kMostLookedAt jobs. Those that ended before the database had version 13 have none, and one whose end
  /// is kept in memory has none yet. Throws Error kDatabase.
  [[nodiscard]] ValueList values(const ValueQuery& query) const;

  /// The statements of the two, for a look at how they are planned.
  [[nodiscard]] static const char* page_sql() noexcept;
  [[nodiscard]] static const char* values_sql() noexcept;

 private:
  const Connection reader_;
  const std::function<KeptEnds()> kept_;
};

}  // namespace fvd
