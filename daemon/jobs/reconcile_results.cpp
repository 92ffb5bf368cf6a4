#include "daemon/jobs/reconcile_results.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/result_json.hpp"
#include "daemon/export/storage_error.hpp"
#include "daemon/jobs/job_values.hpp"
#include "daemon/jobs/result_pipeline.hpp"
#include "daemon/result/evaluate.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRefused = ".refused.tmp";

/// Throws fs::filesystem_error where the disk does not tell.
bool is_as_told(const fs::path& path, const ResultFile& file) {
  const fs::file_status status = fs::status(path);
  if (file.files) return fs::is_directory(status);
  return fs::is_regular_file(status) && fs::file_size(path) == file.size_bytes;
}

/// Empty where the folder holds all that its result.json lists.
std::string what_is_missing(const fs::path& folder, const Result& result, const std::string& job_id) {
  if (result.job.id != job_id) return "it is the result of job " + result.job.id;
  for (const ResultFile& file : result.files) {
    if (file.state == FileState::kWritten && !is_as_told(folder / file.name, file))
      return file.name + " is missing or cut off";
  }
  return {};
}

/// The job with the result of its folder, or why the folder is none.
struct Found {
  std::optional<StoredJob> whole;
  std::string problem;
  bool is_unknown = false;  ///< its text is complete and says what this version does not know: a newer one may
};

/// Throws Error and fs::filesystem_error where the folder cannot be read: that tells nothing of what is in it.
Found result_in(const fs::path& folder, const JobStatus& interrupted) {
  if (!fs::exists(folder / "result.json")) return {std::nullopt, "it has no result.json"};
  const std::string text = read_text_file(folder / "result.json", kAnyLength);
  try {
    StoredJob job{interrupted, folder.string(), text};
    const Result result = read_result_json(job.result_json);
    if (const std::string problem = what_is_missing(folder, result, interrupted.job_id); !problem.empty()) {
      return {std::nullopt, problem};
    }
    JobStatus& status = job.status;
    status.state = JobState::kCompleted;
    status.acquired = false;  // the result does not tell whether standstill was measured; part_release tells of now
    status.error.reset();
    status.error_message.clear();
    if (const auto shortage = shortfall(result)) {
      status.state = JobState::kFailed;
      status.error = shortage->code;
      status.error_message = shortage->message;
    }
    status.slices_planned = result.slices.planned;
    status.slices_done = result.slices.measured;
    status.frames = result.frames;
    note_verdict(result, status.verdict, status.reason_codes);
    job.values = values_of(result);
    job.files_pending = std::any_of(result.files.begin(), result.files.end(), [](const ResultFile& file) {
      const bool no_digest = file.state == FileState::kWritten && !file.files && file.sha256.empty();
      return file.state == FileState::kPending || no_digest;
    });
    return {std::move(job), {}};
  } catch (const Error& error) {
    return {std::nullopt, error.what(), nlohmann::json::accept(text)};
  }
}

bool ended_by_this_start(const JobStore& store, const std::string& job_id) {
  const auto& ended = store.interrupted_by_start();
  return std::find(ended.begin(), ended.end(), job_id) != ended.end();
}

/// Nothing where it cannot be read.
std::optional<Found> look_into(const fs::path& folder, const JobStatus& interrupted) {
  try {
    return result_in(folder, interrupted);
  } catch (const std::exception& failure) {
    spdlog::error("job {}: {} cannot be read: it stays, and the next start looks again: {}", interrupted.job_id,
                  folder.string(), failure.what());
    return std::nullopt;
  }
}

/// A result that its job cannot have any more: what was told stays, and so does what was measured.
bool set_aside(const fs::path& folder, const fs::path& aside, const std::string& why) {
  try {
    (void)make_directories(aside.parent_path());
    if (file_calls().rename_to_new(folder, aside) != 0) throw storage_error(errno, "rename it to", aside);
  } catch (const Error& failure) {
    spdlog::error("{}: {}; it cannot be moved to {}, and stays where it is: {}", folder.string(), why, aside.string(),
                  failure.what());
    return false;
  }
  spdlog::warn("{}: {}; the whole result is in {} from now on", folder.string(), why, aside.string());
  return true;
}

/// "J-e3" is an evaluation of job J.
bool names_an_evaluation(const std::string& name) {
  const auto mark = name.rfind("-e");
  return mark != std::string::npos && mark + 2 < name.size() &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(mark) + 2, name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// They may have been told by a newer database than the one that was put back.
void name_lost_evaluations(JobStore& store, const fs::path& results) {
  std::error_code error;
  for (fs::directory_iterator entry(results, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with('.') || !names_an_evaluation(name) || store.evaluations().find(name)) continue;
    spdlog::warn("{}: the database does not know this evaluation: it stays, and its number is not used again",
                 entry->path().string());
  }
}

}  // namespace

std::string refused_evaluation(const std::string& evaluation_id) { return "." + evaluation_id + kRefused; }

void restore_refused_evaluations(JobStore& store, const fs::path& results) {
  std::error_code error;
  for (fs::directory_iterator entry(results, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(kRefused)) continue;
    const std::string id = name.substr(1, name.size() - 1 - std::string_view(kRefused).size());
    if (!store.evaluations().find(id)) continue;
    if (file_calls().rename_to_new(entry->path(), results / id) == 0) {
      spdlog::warn("evaluation {} was refused, and its row was on the disk all the same: it is there from now on", id);
      sync_directory(results);
    } else if (errno != EEXIST) {
      // Under its hidden name it would be removed as something that nobody knows.
      throw storage_error(errno, "give its files back to evaluation " + id + ", which has a row, by renaming",
                          entry->path());
    }
  }
}

Reconciled reconcile_results(JobStore& store, const fs::path& results) {
  Reconciled done;
  for (const JobStatus& ended : store.results().without_result()) {
    const fs::path folder = results / ended.job_id;
    std::error_code error;
    if (!fs::exists(folder, error)) continue;
    const auto looked = look_into(folder, ended);
    if (!looked) continue;
    const Found& found = *looked;
    const bool was_told = ended.acknowledged || !ended_by_this_start(store, ended.job_id);
    if (found.whole && !was_told) {
      store.finish(found.whole->status, found.whole->result_dir, found.whole->result_json, found.whole->files_pending,
                   found.whole->values);
      spdlog::warn("job {}: the daemon stopped between its result and its row: it is {} with the result in {}",
                   ended.job_id, job_state_name(found.whole->status.state), folder.string());
      ++done.adopted;
      continue;
    }
    if (found.whole || found.is_unknown) {
      const std::string why = found.whole ? "its job was told without a result and stays so"
                                          : "this version does not know such a result: " + found.problem;
      if (set_aside(folder, results.parent_path() / "set-aside" / ended.job_id, why)) ++done.set_aside;
      continue;
    }
    file_calls().remove_all(folder);
    const bool is_gone = !fs::exists(folder, error);
    spdlog::warn("job {}: {} is no whole result of it: {}: {}", ended.job_id, folder.string(),
                 is_gone ? "removed" : "it cannot be removed, the next start tries again", found.problem);
    if (is_gone) ++done.removed;
  }
  name_lost_evaluations(store, results);
  return done;
}

}  // namespace fvd
