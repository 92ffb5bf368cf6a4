#pragma once

/// Writes down who asked for what, behind whoever asked: nobody waits for its disk.

#include <deque>
#include <functional>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/base/mutex.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/store/audit_table.hpp"

namespace fvd {

/// What the disk does not take is kept and tried again, so many entries at most; the log tells of any that is lost.
/// context: thread-safe.
class AuditLog final : public AuditService {
 public:
  static constexpr std::size_t kMostKept = 1000;

  /// table: outlives it.
  explicit AuditLog(AuditTable& table);
  /// Writes what is left, once.
  ~AuditLog() override;
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  void note(AuditEntry entry) override;
  [[nodiscard]] std::vector<AuditEntry> newest(int most, std::int64_t before) override;

 private:
  void run(const std::stop_token& stop);
  /// False if the disk did not take it.
  bool write();

  AuditTable& table_;
  Mutex mutex_;
  Condition changed_;
  std::deque<AuditEntry> waiting_ FVD_GUARDED_BY(mutex_);
  std::size_t lost_ FVD_GUARDED_BY(mutex_) = 0;  ///< so many were taken from the front without being written
  bool written_ FVD_GUARDED_BY(mutex_) = true;   ///< the table took all there was, the last time
  std::jthread thread_;                          // last
};

}  // namespace fvd
