#include "daemon/jobs/retention.hpp"

#include <chrono>
#include <exception>
#include <system_error>
#include <vector>

#include <spdlog/spdlog.h>

#include "core/base/mutex.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "daemon/export/file_calls.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kPeriod{1};

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

/// Hidden first: whatever happens meanwhile, nobody takes a part for the whole, and the next start clears it.
void remove_whole(const fs::path& folder) {
  const fs::path hidden = folder.parent_path() / ("." + folder.filename().string() + ".removed.tmp");
  if (file_calls().rename(folder, hidden) == 0) file_calls().remove_all(hidden);
}

}  // namespace

void Retention::start() {
  if (!has_limits(config_)) return;
  thread_ = start_thread("fvd-retention", [this](const std::stop_token& stop) { run(stop); });
}

void Retention::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Retention::run(const std::stop_token& stop) {
  Mutex mutex;
  Condition never;
  while (!stop.stop_requested()) {
    run_once(stop);
    MutexLock lock(mutex);
    (void)never.wait_for(lock, stop, kPeriod, [] { return false; });
  }
}

void Retention::run_once(const std::stop_token& stop) noexcept {
  try {
    finish_removals();
    make_room(stop);
  } catch (const std::exception& failure) {
    spdlog::error("no room is made for new results: {}", failure.what());
  }
}

void Retention::finish_removals() {
  for (const std::string& job_id : store_.results().removed_last()) {
    std::error_code error;
    if (fs::exists(results_ / job_id, error)) remove_whole(results_ / job_id);
  }
}

Retention::Size Retention::size_of(const std::string& job_id) {
  const auto known = sizes_.find(job_id);
  if (known != sizes_.end()) return known->second;
  return sizes_[job_id] = {bytes_in(results_ / job_id), bytes_in(results_ / job_id / "slices")};
}

void Retention::make_room(const std::stop_token& stop) {
  const std::vector<StoredJob> jobs = store_.results().on_disk();
  std::vector<KeptResult> results;
  for (const StoredJob& job : jobs) {
    if (stop.stop_requested()) return;
    const bool removable = job.status.acknowledged && !job.files_pending;
    // What may still grow is looked at anew.
    if (!removable) sizes_.erase(job.status.job_id);
    const Size size = size_of(job.status.job_id);
    results.push_back({seconds_since(job.status.ended_utc), size.bytes, size.slices_bytes, removable});
  }
  std::error_code error;
  const fs::space_info disk = fs::space(results_, error);
  if (error) throw std::system_error(error, results_.string());
  for (const RetentionStep& step : retention_plan(results, limits_of(config_), disk.available)) {
    if (stop.stop_requested()) return;
    const StoredJob& job = jobs[step.result];
    step.slices_alone ? remove_slices(job) : remove_result(job);
    sizes_.erase(job.status.job_id);
  }
}

void Retention::remove_slices(const StoredJob& job) {
  spdlog::info("job {}: its recorded slices are removed to make room", job.status.job_id);
  file_calls().remove_all(results_ / job.status.job_id / "slices");
}

void Retention::remove_result(const StoredJob& job) {
  if (!store_.results().mark_removed(job.status.job_id)) return;
  spdlog::info("job {}: its result is removed to make room; what it came to stays known", job.status.job_id);
  remove_whole(results_ / job.status.job_id);
}

}  // namespace fvd
