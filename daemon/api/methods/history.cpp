/// Jobs from the newest on, and how a value went from job to job.

#include "daemon/api/job_cursor.hpp"
#include "daemon/api/list_shapes.hpp"
#include "daemon/api/methods/methods.hpp"
#include "daemon/api/replies.hpp"
#include "daemon/api/result_fields.hpp"
#include "daemon/api/utc_bound.hpp"

namespace fvd {

namespace {

constexpr int kMostJobs = 500;
constexpr int kMostPoints = 2000;
/// A value's name is put together of what the recipe names: longer than other texts.
constexpr std::size_t kLongestValue_bytes = 128;
/// The word of a filter for jobs without a verdict.
constexpr const char* kNoVerdict = "none";

/// A parameter that is left out, or one of these words.
void optional_choice(Fields& fields, const char* name, std::optional<std::string>& value,
                     const std::vector<std::string>& accepted, const char* meaning) {
  fields.optional(name, value, [&](Fields& inner, std::string& word) {
    if (word.empty()) word = accepted.front();
    inner.choice(name, word, accepted, meaning);
  });
}

std::optional<JobState> state_named(const std::string& name) {
  for (const JobState state : {JobState::kProcessing, JobState::kCompleted, JobState::kAborted, JobState::kFailed}) {
    if (job_state_name(state) == name) return state;
  }
  return std::nullopt;
}

struct ListParams {
  std::string before;
  int most = 50;
  JobFilter filter;
  std::optional<std::string> verdict;
  std::optional<std::string> state;

  void describe(Fields& fields) {
    std::vector<std::string> verdicts = kVerdicts;
    verdicts.emplace_back(kNoVerdict);
    fields.text("before", before, kLongestCursor_bytes, "`next` of the part of the list before; empty = the newest");
    fields.integer("most", most, {1, kMostJobs}, "so many");
    fields.text("part_id", filter.part_id, kMaxForeignText_bytes, "only parts whose id begins so; empty = all");
    fields.text("recipe", filter.recipe, kMaxForeignText_bytes, "only of this recipe, by its id; empty = all");
    optional_choice(fields, "verdict", verdict, verdicts,
                    "only with this verdict on the part; none = nothing was judged; absent = all");
    optional_choice(fields, "state", state, kJobStates, "only in this state; absent = all");
    fields.text("from_utc", filter.from_utc, kMaxForeignText_bytes,
                "only jobs that ended then or later: 2026-11-30T10:00:00Z, or with milliseconds; empty = all");
    fields.text("to_utc", filter.to_utc, kMaxForeignText_bytes, "or before, likewise; empty = all");
    fields.text("text", filter.text, kMaxForeignText_bytes,
                "only jobs that have it in job_id, part_id, recipe, client, state or error, capital letters or not; "
                "empty = all");
  }
  [[nodiscard]] JobFilter checked_filter() const {
    JobFilter checked = filter;
    if (verdict) checked.verdict = *verdict == kNoVerdict ? "" : *verdict;
    if (state) checked.state = state_named(*state);
    checked.from_utc = first_moment("from_utc", filter.from_utc);
    checked.to_utc = last_moment("to_utc", filter.to_utc);
    return checked;
  }
};

struct ValuesParams {
  ValueQuery query;

  void describe(Fields& fields) {
    fields.text("measurement", query.measurement, kMaxForeignText_bytes,
                "of the recipe, by its name; map = the height map as a whole, unless the recipe has one of that name");
    fields.require("measurement");
    fields.text("value", query.value, kLongestValue_bytes, "name of the value in the result, as height_um");
    fields.require("value");
    fields.text("recipe", query.recipe, kMaxForeignText_bytes, "only of jobs of this recipe, by its id; empty = all");
    fields.integer("most", query.most, {2, kMostPoints}, "so many of the newest jobs that have the value");
  }
};

void describe_job_page(Fields& fields) {
  const ResultFields result(fields);
  result.list("jobs", kMostJobs, describe_job_row, "the newest first");
  result.text(
      "next", kLongestCursor_bytes,
      "before which the list goes on; empty = these are the last. An answer looks at 20,000 jobs at most: where "
      "few of them fit, it has fewer than were asked for, or none, and still a `next`");
}

void describe_points(Fields& fields) {
  const ResultFields result(fields);
  result.list("points", kMostPoints, describe_value_point,
              "the oldest first, among the newest 20,000 jobs; none of jobs that ended under a version of fvd before "
              "0.6.0");
  result.boolean(
      "searched_all",
      "false = fewer than were asked for have the value, and jobs before the newest 20,000 were not looked at");
}

Answer list_jobs(const HistoryService& history, const ListParams& params) {
  const JobPage page = history.list(params.checked_filter(), before_of_cursor(params.before), params.most);
  Reply jobs = Reply::array();
  for (const JobStatus& job : page.jobs) jobs.push_back(job_row_json(job));
  return Reply{{"jobs", std::move(jobs)}, {"next", job_cursor(page.next)}};
}

Answer list_values(const HistoryService& history, const ValuesParams& params) {
  const ValueList values = history.values(params.query);
  Reply points = Reply::array();
  for (const ValuePoint& point : values.points) points.push_back(value_point_json(point));
  return Reply{{"points", std::move(points)}, {"searched_all", values.searched_all}};
}

}  // namespace

void add_history_methods(MethodTable& methods, const Services& services) {
  methods["job.list"] = {.about = {.summary = "Jobs from the newest on, part by part; the running one too",
                                   .role = Role::kView,
                                   .params = described<ListParams>(),
                                   .result = describe_job_page,
                                   .errors = {ErrorCode::kDatabase},
                                   .is_long = true},
                         .run = with<ListParams>([&history = services.history](const Call&, const ListParams& params) {
                           return list_jobs(history, params);
                         })};
  methods["value.list"] = {
      .about = {.summary = "One value over the newest jobs that have it, for run charts; a result that was removed "
                           "keeps its values",
                .role = Role::kView,
                .params = described<ValuesParams>(),
                .result = describe_points,
                .errors = {ErrorCode::kDatabase},
                .is_long = true},
      .run = with<ValuesParams>([&history = services.history](const Call&, const ValuesParams& params) {
        return list_values(history, params);
      })};
}

}  // namespace fvd
