#include "daemon/jobs/retention.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/replace_file.hpp"
#include "daemon/export/result_json.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kPeriod{1};
constexpr double kGib = 1U << 30U;
constexpr std::chrono::minutes kLongestStep{10};  // of one result

bool has_limits(const StoreConfig& config) {
  return config.keep_days > 0 || config.keep_gib > 0 || config.keep_free_gib > 0;
}

RetentionLimits limits_of(const StoreConfig& config) {
  const auto gib = [](int number) { return static_cast<std::uint64_t>(number) << 30U; };
  RetentionLimits limits;
  if (config.keep_days > 0) limits.longest_s = std::int64_t{config.keep_days} * 24 * 3600;
  if (config.keep_gib > 0) limits.most_bytes = gib(config.keep_gib);
  if (config.keep_free_gib > 0) limits.least_free_bytes = gib(config.keep_free_gib);
  return limits;
}

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored)) bytes += entry->file_size(ignored);
  }
  return bytes;
}

/// Renamed to what is hidden first: whatever happens meanwhile, nobody takes a part for the whole, and the next start
/// clears it.
void remove_by(const fs::path& folder, const fs::path& hidden) {
  std::error_code error;
  if (file_calls().rename(folder, hidden) != 0) error.assign(errno, std::generic_category());
  file_calls().remove_all(hidden);
  std::error_code ignored;
  if (!error && !fs::exists(hidden, ignored)) return;
  spdlog::error("{} cannot be removed to make room: {}", folder.string(),
                error ? error.message() : "a part of it stays as " + hidden.string());
}

void remove_whole(const fs::path& folder) {
  remove_by(folder, folder.parent_path() / ("." + folder.filename().string() + ".removed.tmp"));
}

/// The folders of all evaluations, by their jobs.
std::map<std::string, std::vector<std::string>> evaluations_in(const fs::path& results) {
  std::map<std::string, std::vector<std::string>> found;
  std::error_code error;
  for (fs::directory_iterator entry(results, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto mark = name.rfind("-e");
    if (mark != std::string::npos && !name.starts_with('.')) found[name.substr(0, mark)].push_back(name);
  }
  return found;
}

/// The text of a result whose recorded slices are gone.
std::string without_slices(const std::string& text) {
  Result result = read_result_json(text);
  for (ResultFile& file : result.files) {
    if (file.name != "slices/") continue;
    file = {.name = file.name, .state = FileState::kNotMade, .reason = "removed to make room at " + utc_now()};
  }
  return result_json_with_files(text, result.files, result.times.follow_ms.value_or(0.0));
}

}  // namespace

Retention::Retention(JobStore& store, const StoreConfig& config, fs::path results)
    : store_(store), config_(config), results_(std::move(results)), ticks_("fvd-retention", kLongestStep) {}

void Retention::start() {
  thread_ = start_thread("fvd-retention", [this](const std::stop_token& stop) { run(stop); });
}

void Retention::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Retention::set_limits(const StoreConfig& limits) {
  const MutexLock lock(mutex_);
  config_ = limits;
  has_other_limits_ = true;
  limits_changed_.notify_all();
}

void Retention::run(const std::stop_token& stop) {
  // At the start in any case: removals that were cut off are finished, whatever the limits are now.
  for (bool first = true; !stop.stop_requested(); first = false) {
    if (first || has_limits(config())) run_once(stop);
    ticks_.rest();
    MutexLock lock(mutex_);
    const bool are_others = limits_changed_.wait_for(lock, stop, kPeriod, [this] {
      mutex_.assert_held();
      return std::exchange(has_other_limits_, false);
    });
    if (are_others) is_short_ = false;  // what was told was told of the limits before
  }
}

void Retention::run_once(const std::stop_token& stop) noexcept {
  try {
    finish_removals();
    if (has_limits(config())) make_room(stop);
  } catch (const std::exception& failure) {
    spdlog::error("no room is made for new results: {}", failure.what());
  }
}

void Retention::finish_removals() {
  ticks_.tick(HostClock::now());
  evaluations_ = evaluations_in(results_);
  for (const std::string& job_id : store_.results().removed_last()) remove_folders(job_id);
}

Retention::Size Retention::size_of(const std::string& job_id) {
  const auto known = sizes_.find(job_id);
  if (known != sizes_.end()) return known->second;
  return sizes_[job_id] = {bytes_in(results_ / job_id), bytes_in(results_ / job_id / "slices")};
}

std::uint64_t Retention::evaluation_bytes(const std::string& job_id) {
  std::uint64_t bytes = 0;
  const auto found = evaluations_.find(job_id);
  if (found == evaluations_.end()) return 0;
  for (const std::string& name : found->second) bytes += size_of(name).bytes;
  return bytes;
}

void Retention::make_room(const std::stop_token& stop) {
  const std::vector<StoredJob> jobs = store_.results().on_disk();
  std::vector<KeptResult> results;
  for (const StoredJob& job : jobs) {
    if (stop.stop_requested()) return;
    ticks_.tick(HostClock::now());
    const bool removable = job.status.acknowledged && !job.files_pending;
    // What may still grow is looked at anew.
    if (!removable) sizes_.erase(job.status.job_id);
    const Size size = size_of(job.status.job_id);
    const std::uint64_t bytes = size.bytes + evaluation_bytes(job.status.job_id);
    results.push_back({seconds_since(job.status.ended_utc), bytes, size.slices_bytes, removable});
  }
  std::error_code error;
  const fs::space_info disk = fs::space(results_, error);
  if (error) throw std::system_error(error, results_.string());
  RetentionLimits limits = limits_of(config());
  // No disk is freer than it is large: a digit too many would remove whatever was measured.
  if (limits.least_free_bytes > disk.capacity) limits.least_free_bytes = {};
  for (const RetentionStep& step : retention_plan(results, limits, disk.available)) {
    if (stop.stop_requested()) return;
    ticks_.tick(HostClock::now());
    const StoredJob& job = jobs[step.result];
    step.slices_alone ? remove_slices(job) : remove_result(job);
    sizes_.erase(job.status.job_id);
  }
  note_shortage();
}

void Retention::note_shortage() {
  const int wanted_gib = config().keep_free_gib;
  const fs::space_info disk = fs::space(results_);
  const auto free_gib = static_cast<double>(disk.available) / kGib;
  const auto whole_gib = static_cast<double>(disk.capacity) / kGib;
  const auto may_go = [](const StoredJob& job) { return job.status.acknowledged && !job.files_pending; };
  const auto any_may_go = [&] {  // what was freed by the last steps may be less than was counted: the next look goes on
    const std::vector<StoredJob> left = store_.results().on_disk();
    return std::any_of(left.begin(), left.end(), may_go);
  };
  const bool is_short = wanted_gib > 0 && free_gib < wanted_gib && (whole_gib < wanted_gib || !any_may_go());
  const bool was_short = std::exchange(is_short_, is_short);
  if (!is_short_ || was_short) return;
  spdlog::warn("store.keep_free_gib: {} GiB are to be free, {:.1f} of the disk's {:.1f} are{}", wanted_gib, free_gib,
               whole_gib,
               whole_gib < wanted_gib ? ": the disk is smaller than that, and nothing is removed for it: give less"
                                      : ", and no acknowledged result is left to remove: acknowledge results, or make "
                                        "room on the disk");
}

void Retention::remove_slices(const StoredJob& job) {
  const std::string& job_id = job.status.job_id;
  try {
    const std::string text = without_slices(store_.find(job_id).result_json);
    replace_file(results_ / job_id / "result.json", [&text](const ByteSink& sink) { sink(text); });
    store_.note_files(job_id, text, false);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadInput) throw;  // of the disk: what is not told is not removed
    spdlog::warn("job {}: that its slices are removed cannot be told in its result: {}", job_id, error.what());
  }
  spdlog::info("job {}: its recorded slices are removed to make room", job_id);
  remove_by(results_ / job_id / "slices", results_ / ("." + job_id + ".slices.removed.tmp"));
}

void Retention::remove_result(const StoredJob& job) {
  if (!store_.results().mark_removed(job.status.job_id)) return;
  spdlog::info("job {}: its result is removed to make room; what it came to stays known", job.status.job_id);
  remove_folders(job.status.job_id);
}

void Retention::remove_folders(const std::string& job_id) {
  std::error_code error;
  if (fs::exists(results_ / job_id, error)) remove_whole(results_ / job_id);
  const auto found = evaluations_.find(job_id);
  if (found == evaluations_.end()) return;
  for (const std::string& name : found->second) {
    remove_whole(results_ / name);
    sizes_.erase(name);
  }
  evaluations_.erase(found);
}

}  // namespace fvd
