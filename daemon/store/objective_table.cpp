#include "daemon/store/objective_table.hpp"

namespace fvd {

namespace {

std::optional<ObjectiveConfirmation> latest_in(const Database& database) {
  Statement rows(database,
                 "SELECT objective, person, confirmed_utc FROM objective_confirmations ORDER BY number DESC LIMIT 1");
  if (!rows.step()) return std::nullopt;
  return ObjectiveConfirmation{rows.text(0), rows.text(1), rows.text(2)};
}

}  // namespace

std::optional<ObjectiveConfirmation> ObjectiveTable::latest() const {
  const MutexLock lock(reader_.mutex);
  return latest_in(reader_.database);
}

ObjectiveConfirmation ObjectiveTable::add(const std::string& objective, const std::string& person) {
  const MutexLock lock(writer_.mutex);
  Transaction transaction(writer_.database);
  Statement(writer_.database, "INSERT INTO objective_confirmations (objective, person) VALUES (?, ?)")
      .bind(objective)
      .bind(person)
      .run();
  ObjectiveConfirmation added = latest_in(writer_.database).value();
  transaction.commit();
  return added;
}

}  // namespace fvd
