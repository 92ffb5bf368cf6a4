#pragma once

/// Writes down who asked for what, behind whoever asked: nobody waits for its disk.

#include <cstdint>
#include <deque>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/clock.hpp"
#include "core/base/mutex.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/store/audit_table.hpp"

namespace fvd {

/// What the disk does not take is kept and tried again, so many entries at most; the log tells how many were lost.
/// Whoever is refused again and again takes so many rows a minute, and one that counts the others: rows that matter are
/// not pushed out. The end of what was accepted is no refusal, whatever came of it. context: thread-safe.
class AuditLog final : public AuditService {
 public:
  static constexpr std::size_t kMostKept = 1000;
  static constexpr int kMostRefusals = 30;          ///< a minute, of one identity
  static constexpr std::size_t kMostRefused = 200;  ///< identities that are counted apart; all others are as one

  /// table: outlives it.
  explicit AuditLog(AuditTable& table);
  /// Writes what is left, once.
  ~AuditLog() override;
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  void note(AuditEntry entry) override;
  /// Waits a tenth of a second at most for what was noted just before.
  [[nodiscard]] std::vector<AuditEntry> newest(int most, std::int64_t before) override;

 private:
  /// Of one identity, within the minute that began then.
  struct Refusals {
    HostTime since;
    int rows = 0;
    AuditEntry last;
    std::int64_t not_listed = 0;
  };

  /// False: it is counted, and has no row of its own.
  bool is_listed_locked(const AuditEntry& entry) FVD_REQUIRES(mutex_);
  void close_minutes_locked(HostTime now, bool all) FVD_REQUIRES(mutex_);
  void keep_locked(AuditEntry entry) FVD_REQUIRES(mutex_);
  void drop_oldest_locked() FVD_REQUIRES(mutex_);
  /// Before those that came meanwhile.
  void put_back_locked(std::vector<AuditEntry> entries) FVD_REQUIRES(mutex_);
  void run(const std::stop_token& stop);
  /// False if the disk did not take it.
  bool write();

  AuditTable& table_;
  Mutex mutex_;
  Condition changed_;
  std::deque<AuditEntry> waiting_ FVD_GUARDED_BY(mutex_);
  std::map<std::string, Refusals> refusals_ FVD_GUARDED_BY(mutex_);  ///< by who was refused; kOthers = the rest
  std::int64_t lost_ FVD_GUARDED_BY(mutex_) = 0;    ///< so many found no place, since the table took everything
  bool is_writing_ FVD_GUARDED_BY(mutex_) = false;  ///< what was taken from those that wait
  bool written_ FVD_GUARDED_BY(mutex_) = true;      ///< the table took all there was, the last time
  std::jthread thread_;                             // last
};

}  // namespace fvd
