#pragma once

/// The objectives of the configuration, and the one that was confirmed.

#include <string>
#include <vector>

#include "daemon/config/config.hpp"
#include "daemon/jobs/machine_board.hpp"
#include "daemon/jobs/services.hpp"
#include "daemon/store/objective_table.hpp"

namespace fvd {

/// context: thread-safe. What is confirmed is made durable with no lock held; meanwhile the machine takes no job and no
/// command, so that nothing runs with two objectives.
class ObjectiveBook final : public ObjectiveService {
 public:
  /// Tells the board what was confirmed last, if the configuration still names it. What they refer to outlives the
  /// book. Throws Error kDatabase.
  ObjectiveBook(const std::vector<ObjectiveConfig>& objectives, ObjectiveTable& table, MachineBoard& board);

  [[nodiscard]] Known known() const override;
  ObjectiveConfirmation confirm(const std::string& name, const std::string& person) override;

 private:
  const std::vector<ObjectiveConfig>& objectives_;
  ObjectiveTable& table_;
  MachineBoard& board_;
};

/// That a job of this recipe may run with the objective that was confirmed ("" = none was). Throws Error
/// kObjectiveMismatch. context: pure.
void require_objective(const std::string& recipe_objective, const std::string& confirmed,
                       const std::vector<ObjectiveConfig>& objectives);

}  // namespace fvd
