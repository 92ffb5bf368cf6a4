#pragma once

/// The values of a result as the rows of a table.

#include <optional>
#include <string>
#include <vector>

#include "core/surface/verdict.hpp"
#include "daemon/result/result.hpp"

namespace fvd {

/// Cells as text.
struct ValueRow {
  std::string measurement;  ///< empty where it is the one of the row above
  std::string name;         ///< without unit; of R values with the settings: "Ra (0.08 mm x 5)"
  std::string value;        ///< "-" where there is none
  std::string uncertainty;  ///< U and k; "-" where it is not known
  std::string unit;         ///< "µm", "°", "%", "ml/m²"; empty for a plain number
  std::string limits;
  std::optional<Verdict> verdict;
  std::string reason;  ///< why there is no value
};

/// In the recipe's order; of a measurement its main value first, then the others that have limits, then the rest.
/// Behind them what of the map was judged; all values of the map where nothing was evaluated.
[[nodiscard]] std::vector<ValueRow> value_rows(const Result& result);

/// " um" behind a number in a text of the program as " µm".
[[nodiscard]] std::string with_micro_sign(std::string text);

/// "um" as "µm", "deg" as "°" and so on.
[[nodiscard]] std::string unit_text(const std::string& unit);

}  // namespace fvd
