#include "daemon/jobs/audit_log.hpp"

#include <chrono>
#include <ctime>
#include <iterator>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"
#include "core/runtime/thread_ticks.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kRetryPeriod{1};
constexpr std::chrono::minutes kLongestWrite{2};        // the database's own patience, some times
constexpr std::chrono::milliseconds kLongestRead{100};  // that a reader waits for what is not written yet
constexpr std::chrono::minutes kRefusalsPeriod{1};
constexpr const char* kOthers = "";  // no identity: all for whom there is no counter of their own

std::string now_utc() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const std::time_t seconds = system_clock::to_time_t(now);
  const auto part = duration_cast<milliseconds>(now.time_since_epoch()).count() % 1000;
  std::tm utc{};
  ::gmtime_r(&seconds, &utc);
  char text[40];
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  const std::string digits = std::to_string(1000 + part).substr(1);
  return std::string(text, size) + "." + digits + "Z";
}

}  // namespace

AuditLog::AuditLog(AuditTable& table)
    : table_(table), thread_(start_thread("fvd-audit", [this](const std::stop_token& stop) { run(stop); })) {}

AuditLog::~AuditLog() {
  thread_.request_stop();
  thread_.join();
  const MutexLock lock(mutex_);
  if (!waiting_.empty() || lost_ > 0) {
    spdlog::error("{} entries of who asked for what are not written down", lost_ + std::ssize(waiting_));
  }
}

void AuditLog::note(AuditEntry entry) {
  entry.time_utc = now_utc();
  {
    const MutexLock lock(mutex_);
    if (!is_listed_locked(entry)) return;
    keep_locked(std::move(entry));
  }
  changed_.notify_all();
}

void AuditLog::keep_locked(AuditEntry entry) {
  if (waiting_.size() == kMostKept) drop_oldest_locked();
  waiting_.push_back(std::move(entry));
}

void AuditLog::drop_oldest_locked() {
  if (lost_++ == 0) {
    spdlog::error("not written down, for the database takes nothing: {} by {}; others follow it, their number is told",
                  waiting_.front().what, waiting_.front().who);
  }
  waiting_.pop_front();
}

void AuditLog::put_back_locked(std::vector<AuditEntry> entries) {
  waiting_.insert(waiting_.begin(), std::make_move_iterator(entries.begin()), std::make_move_iterator(entries.end()));
  while (waiting_.size() > kMostKept) drop_oldest_locked();
}

bool AuditLog::is_listed_locked(const AuditEntry& entry) {
  if (entry.is_end || entry.outcome == "ok" || entry.outcome == "accepted") return true;
  const HostTime now = HostClock::now();
  close_minutes_locked(now, false);
  const bool has_counter = refusals_.contains(entry.who) || refusals_.size() < kMostRefused;
  const std::string key = has_counter ? entry.who : kOthers;
  Refusals& refusals = refusals_.try_emplace(key, Refusals{.since = now, .last = {}}).first->second;
  if (++refusals.rows <= kMostRefusals) return true;
  ++refusals.not_listed;
  refusals.last = entry;
  return false;
}

void AuditLog::close_minutes_locked(HostTime now, bool all) {
  for (auto at = refusals_.begin(); at != refusals_.end();) {
    Refusals& refusals = at->second;
    if (!all && now - refusals.since < kRefusalsPeriod) {
      ++at;
      continue;
    }
    if (refusals.not_listed > 0) {
      const std::string whose = at->first == kOthers ? " refusals of others" : " refusals";
      refusals.last.detail = std::to_string(refusals.not_listed) + whose + " within a minute; this is the last";
      keep_locked(std::move(refusals.last));
    }
    at = refusals_.erase(at);
  }
}

std::vector<AuditEntry> AuditLog::newest(int most, std::int64_t before) {
  {
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kLongestRead, [this] {
      mutex_.assert_held();
      return (waiting_.empty() && !is_writing_) || !written_;
    });
  }
  return table_.newest(most, before);
}

void AuditLog::run(const std::stop_token& stop) {
  ThreadTicks ticks("fvd-audit", kLongestWrite);
  while (!stop.stop_requested()) {
    ticks.tick(HostClock::now());
    const bool written = write();
    ticks.rest();
    MutexLock lock(mutex_);
    if (written) {
      changed_.wait_for(lock, stop, kRefusalsPeriod, [this] {
        mutex_.assert_held();
        return !waiting_.empty();
      });
      close_minutes_locked(HostClock::now(), false);
    } else {
      changed_.wait_for(lock, stop, kRetryPeriod, [] { return false; });
    }
  }
  {
    const MutexLock lock(mutex_);
    close_minutes_locked(HostClock::now(), true);
  }
  ticks.tick(HostClock::now());
  (void)write();
}

bool AuditLog::write() {
  std::vector<AuditEntry> entries;
  {
    const MutexLock lock(mutex_);
    entries.assign(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    is_writing_ = !entries.empty();
  }
  if (entries.empty()) return true;
  std::string failure;
  try {
    table_.add(entries);
  } catch (const Error& error) {
    failure = error.what();
  }
  const bool written = failure.empty();
  {
    const MutexLock lock(mutex_);
    if (!written) {
      if (written_) spdlog::error("who asked for what cannot be written down: {}; it is tried again", failure);
      put_back_locked(std::move(entries));
    } else if (lost_ > 0) {
      spdlog::error("{} entries of who asked for what were lost while the database took nothing", lost_);
      lost_ = 0;
    }
    written_ = written;
    is_writing_ = false;
  }
  changed_.notify_all();
  return written;
}

}  // namespace fvd
