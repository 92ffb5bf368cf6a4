#include "daemon/jobs/audit_log.hpp"

#include <chrono>
#include <ctime>
#include <utility>

#include <spdlog/spdlog.h>

#include "core/base/error.hpp"
#include "core/runtime/guarded_thread.hpp"

namespace fvd {

namespace {

constexpr std::chrono::seconds kRetryPeriod{1};
constexpr std::chrono::seconds kLongestRead{2};  // that a reader waits for what is not written yet

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
  for (const AuditEntry& lost : waiting_) spdlog::error("not written down: {} by {}", lost.what, lost.who);
}

void AuditLog::note(AuditEntry entry) {
  entry.time_utc = now_utc();
  {
    const MutexLock lock(mutex_);
    if (waiting_.size() == kMostKept) {
      spdlog::error("not written down, for the database takes nothing: {} by {}", waiting_.front().what,
                    waiting_.front().who);
      waiting_.pop_front();
      ++lost_;
    }
    waiting_.push_back(std::move(entry));
  }
  changed_.notify_all();
}

std::vector<AuditEntry> AuditLog::newest(int most, std::int64_t before) {
  {
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kLongestRead, [this] {
      mutex_.assert_held();
      return waiting_.empty() || !written_;
    });
  }
  return table_.newest(most, before);
}

void AuditLog::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const bool written = write();
    MutexLock lock(mutex_);
    if (written) {
      changed_.wait(lock, stop, [this] {
        mutex_.assert_held();
        return !waiting_.empty();
      });
    } else {
      changed_.wait_for(lock, stop, kRetryPeriod, [] { return false; });
    }
  }
  (void)write();
}

bool AuditLog::write() {
  std::vector<AuditEntry> entries;
  {
    const MutexLock lock(mutex_);
    lost_ = 0;
    entries.assign(waiting_.begin(), waiting_.end());
  }
  if (entries.empty()) return true;
  bool written = true;
  try {
    table_.add(entries);
  } catch (const Error& error) {
    written = false;
    const MutexLock lock(mutex_);
    if (written_) spdlog::error("who asked for what cannot be written down: {}; it is tried again", error.what());
  }
  {
    const MutexLock lock(mutex_);
    written_ = written;
    // Entries that came meanwhile stand behind these.
    for (std::size_t i = lost_; written && i < entries.size(); ++i) waiting_.pop_front();
  }
  changed_.notify_all();
  return written;
}

}  // namespace fvd
