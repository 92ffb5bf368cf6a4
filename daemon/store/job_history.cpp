#include "daemon/store/job_history.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace fvd {

namespace {

/// Whether a row fits the filter, which is bound as the parameters 1 to 8. The last one is a text in small letters.
#define FVD_FITS                                                                                                \
  "(?1 = '' OR substr(part_id, 1, length(?1)) = ?1) AND (?2 = '' OR recipe = ?2) AND (?3 = 0 OR verdict = ?4) " \
  "AND (?5 = '' OR state = ?5) AND (?6 = '' OR ended_utc >= ?6) "                                               \
  "AND (?7 = '' OR (ended_utc <> '' AND ended_utc <= ?7)) "                                                     \
  "AND (?8 = '' OR instr(lower(job_id || char(10) || part_id || char(10) || recipe || char(10) || client || "   \
  "char(10) || state || char(10) || error), ?8) > 0)"

constexpr const char* kRows =
    "SELECT number, job_id, client, seq, part_id, recipe, state, verdict, ended_utc, error "
    "FROM jobs INDEXED BY jobs_history WHERE number < ?9 AND number > ?12 AND ((" FVD_FITS
    ") OR (?10 <> '' AND instr(?10, char(10) || job_id || char(10)) > 0)) ORDER BY number DESC LIMIT ?11";

/// The same of a job that is given, for an end that no row has.
constexpr const char* kFits =
    "SELECT 1 FROM (SELECT ?9 AS job_id, ?10 AS client, ?11 AS part_id, ?12 AS recipe, ?13 AS state, ?14 AS verdict, "
    "?15 AS ended_utc, ?16 AS error) WHERE " FVD_FITS;

/// A job's values stand together, so a job that has not this one costs one look.
constexpr const char* kValues =
    "SELECT job_id, part_id, ended_utc, value, u, expanded_u, lower, upper, job_values.verdict "
    "FROM jobs INDEXED BY jobs_history CROSS JOIN job_values "
    "ON job_values.number = jobs.number AND measurement = ?1 AND name = ?2 "
    "WHERE jobs.number > ?5 AND (?3 = '' OR recipe = ?3) ORDER BY jobs.number DESC LIMIT ?4";

/// The newest of the jobs behind so many.
constexpr const char* kBehind =
    "SELECT number FROM jobs INDEXED BY jobs_history WHERE number < ?1 ORDER BY number DESC LIMIT 1 OFFSET ?2";
constexpr std::int64_t kNewest = std::numeric_limits<std::int64_t>::max();

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

void bind(const JobFilter& filter, Statement& statement) {
  statement.bind(filter.part_id)
      .bind(filter.recipe)
      .bind(std::int64_t{filter.verdict.has_value()})
      .bind(filter.verdict.value_or(""))
      .bind(filter.state ? job_state_name(*filter.state) : std::string_view())
      .bind(filter.from_utc)
      .bind(filter.to_utc)
      .bind(in_small_letters(filter.text));
}

std::string_view error_text(const JobStatus& job) { return job.error ? error_name(*job.error) : std::string_view(); }

bool fits(const Database& database, const JobFilter& filter, const JobStatus& job) {
  Statement asked(database, kFits);
  bind(filter, asked);
  asked.bind(job.job_id)
      .bind(job.request.client)
      .bind(job.request.part_id)
      .bind(job.request.recipe)
      .bind(job_state_name(job.state))
      .bind(job.verdict)
      .bind(job.ended_utc)
      .bind(error_text(job));
  return asked.step();
}

JobStatus job_of(const Statement& row) {
  JobStatus job;
  job.job_id = row.text(1);
  job.request.client = row.text(2);
  job.request.seq = row.integer(3);
  job.request.part_id = row.text(4);
  job.request.recipe = row.text(5);
  job.state = job_state_in_row(row.text(6));
  job.verdict = row.text(7);
  job.ended_utc = row.text(8);
  if (const std::string name = row.text(9); !name.empty()) job.error = error_from_name(name);
  return job;
}

/// The number of the first job that is not looked at; 0 = all are.
std::int64_t behind(const Database& database, std::int64_t before) {
  Statement row(database, kBehind);
  row.bind(before).bind(JobHistory::kMostLookedAt);
  return row.step() ? row.integer(0) : 0;
}

/// "\nJ1\nJ2\n"; empty without any.
std::string ids_of(const KeptEnds& kept) {
  std::string ids;
  for (const auto& [job_id, unused] : kept) ids += (ids.empty() ? "\n" : "") + job_id + "\n";
  return ids;
}

}  // namespace

JobPage JobHistory::page(const JobFilter& filter, std::int64_t before, int most) const {
  const KeptEnds kept = kept_();
  const MutexLock lock(reader_.mutex);
  const std::int64_t newest = before > 0 ? before : kNewest;
  const std::int64_t left = behind(reader_.database, newest);
  Statement rows(reader_.database, kRows);
  bind(filter, rows);
  // One more tells whether there is a next part; of those whose end is kept any may not fit.
  rows.bind(newest).bind(ids_of(kept)).bind(most + 1 + static_cast<std::int64_t>(kept.size())).bind(left);
  JobPage page;
  std::int64_t last = 0;
  while (rows.step()) {
    JobStatus job = job_of(rows);
    if (const auto end = kept.find(job.job_id); end != kept.end()) {
      job = end->second.status;
      if (!fits(reader_.database, filter, job)) continue;
    }
    if (static_cast<int>(page.jobs.size()) == most) {
      page.next = last;
      break;
    }
    last = rows.integer(0);
    page.jobs.push_back(std::move(job));
  }
  if (page.next == 0 && left > 0) page.next = left + 1;
  return page;
}

const char* JobHistory::page_sql() noexcept { return kRows; }

const char* JobHistory::values_sql() noexcept { return kValues; }

ValueList JobHistory::values(const ValueQuery& query) const {
  const MutexLock lock(reader_.mutex);
  const std::int64_t left = behind(reader_.database, kNewest);
  Statement rows(reader_.database, kValues);
  rows.bind(query.measurement).bind(query.value).bind(query.recipe).bind(std::int64_t{query.most}).bind(left);
  std::vector<ValuePoint> points;
  while (rows.step()) {
    points.push_back({rows.text(0),
                      rows.text(1),
                      rows.text(2),
                      {query.measurement, query.value, rows.real(3), rows.real(4), rows.real(5), rows.real(6),
                       rows.real(7), rows.text(8)}});
  }
  std::reverse(points.begin(), points.end());
  const bool searched_all = left == 0 || static_cast<int>(points.size()) == query.most;
  return {std::move(points), searched_all};
}

}  // namespace fvd
