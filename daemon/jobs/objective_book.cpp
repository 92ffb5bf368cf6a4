#include "daemon/jobs/objective_book.hpp"

#include <optional>

#include <spdlog/spdlog.h>

#include "config/nearest_name.hpp"
#include "core/base/error.hpp"
#include "daemon/jobs/objective_limits.hpp"

namespace fvd {

namespace {

std::vector<std::string> names_of(const std::vector<ObjectiveConfig>& objectives) {
  std::vector<std::string> names;
  for (const ObjectiveConfig& objective : objectives) names.push_back(objective.name);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

std::string unknown(const std::string& name, const std::vector<ObjectiveConfig>& objectives) {
  if (objectives.empty()) return "'" + name + "' is no objective: the configuration names none under /objectives";
  const auto names = names_of(objectives);
  return "'" + name + "' is no objective of the configuration; expected one of " + listed(names) +
         did_you_mean(name, names);
}

}  // namespace

ObjectiveBook::ObjectiveBook(const std::vector<ObjectiveConfig>& objectives, ObjectiveTable& table, MachineBoard& board)
    : objectives_(objectives), table_(table), board_(board) {
  if (objectives_.empty()) return;
  const auto confirmed = known().confirmed;
  if (!confirmed) {
    spdlog::warn(
        "no objective is confirmed: recipes that name one are refused, and no objective's soft limits hold, until "
        "'fvdctl objective confirm NAME'");
    return;
  }
  board_.update([&confirmed](MachineRecord& machine) { machine.objective = confirmed->objective; });
}

ObjectiveService::Known ObjectiveBook::known() const {
  Known known{objectives_, table_.latest()};
  // Nothing is to be relied on of an objective that the configuration does not describe any more.
  if (known.confirmed && find_objective(objectives_, known.confirmed->objective) == nullptr) known.confirmed.reset();
  return known;
}

ObjectiveConfirmation ObjectiveBook::confirm(const std::string& name, const std::string& person) {
  if (find_objective(objectives_, name) == nullptr) throw Error(ErrorCode::kBadInput, unknown(name, objectives_));
  board_.update([](MachineRecord& machine) {
    machine.require_objective_unused();
    machine.confirming = true;
  });
  try {
    ObjectiveConfirmation confirmed = table_.add(name, person);
    board_.update([&name](MachineRecord& machine) {
      machine.confirming = false;
      machine.objective = name;
    });
    spdlog::info("objective '{}' confirmed by {}", name, person);
    return confirmed;
  } catch (...) {
    board_.update([](MachineRecord& machine) { machine.confirming = false; });
    throw;
  }
}

void require_objective(const std::string& recipe_objective, const std::string& confirmed,
                       const std::vector<ObjectiveConfig>& objectives) {
  if (recipe_objective.empty() || recipe_objective == confirmed) return;
  std::string message = "the recipe's /acquire/objective is '" + recipe_objective + "', ";
  if (find_objective(objectives, recipe_objective) == nullptr) {
    message += "but " + unknown(recipe_objective, objectives);
  } else if (confirmed.empty()) {
    message += "but nobody has confirmed which one is on the microscope: look, then 'fvdctl objective confirm NAME'";
  } else {
    message += "but '" + confirmed +
               "' is the one that was confirmed: mount the recipe's and 'fvdctl objective confirm \"" +
               recipe_objective + "\"', or use another recipe";
  }
  throw Error(ErrorCode::kObjectiveMismatch, message);
}

}  // namespace fvd
