#include "daemon/store/audit_table.hpp"

#include <limits>

namespace fvd {

void AuditTable::add(const std::vector<AuditEntry>& entries) {
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  for (const AuditEntry& entry : entries) {
    Statement(writer_.database,
              "INSERT INTO audit (time_utc, who, role, peer, client, what, detail, outcome) "
              "VALUES (?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(entry.time_utc)
        .bind(entry.who)
        .bind(entry.role)
        .bind(entry.peer)
        .bind(entry.client)
        .bind(entry.what)
        .bind(entry.detail)
        .bind(entry.outcome)
        .run();
  }
  Statement(writer_.database, "DELETE FROM audit WHERE number <= (SELECT max(number) FROM audit) - ?")
      .bind(kRowsKept)
      .run();
  transaction.commit();
}

std::vector<AuditEntry> AuditTable::newest(int most, std::int64_t before) const {
  const MutexLock lock(reader_.mutex);
  Statement rows(reader_.database,
                 "SELECT number, time_utc, who, role, peer, client, what, detail, outcome FROM audit "
                 "WHERE number < ? ORDER BY number DESC LIMIT ?");
  rows.bind(before > 0 ? before : std::numeric_limits<std::int64_t>::max()).bind(std::int64_t{most});
  std::vector<AuditEntry> entries;
  while (rows.step()) {
    entries.push_back({rows.integer(0), rows.text(1), rows.text(2), rows.text(3), rows.text(4), rows.text(5),
                       rows.text(6), rows.text(7), rows.text(8)});
  }
  return entries;
}

}  // namespace fvd
