#pragma once

/// What an operation did to a surface.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fvd::metrology {

/// A parameter that an operation used or fitted.
struct NamedValue {
  std::string name;                      ///< with its unit as suffix where it has one: "radius_um", "slope_x"
  double value = 0.0;                    ///< finite
  std::optional<double> standard_error;  ///< of a fitted value, in the same unit; absent where it is not estimated
};

/// Every operation returns one. The surface is unchanged exactly where `refused` has a text.
struct OperationReport {
  std::optional<std::string> refused;  ///< why the operation could not be done
  std::size_t points_used = 0;         ///< points that a fit rests on, or that were judged
  std::size_t points_removed = 0;      ///< points that became holes
  std::vector<NamedValue> values;      ///< in a fixed order per operation
  std::vector<std::string> warnings;

  /// The value of that name; null where there is none.
  [[nodiscard]] const NamedValue* find(const std::string& name) const {
    for (const NamedValue& value : values) {
      if (value.name == name) return &value;
    }
    return nullptr;
  }
};

[[nodiscard]] inline OperationReport refusal(std::string reason) {
  OperationReport report;
  report.refused = std::move(reason);
  return report;
}

}  // namespace fvd::metrology
