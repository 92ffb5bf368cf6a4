#pragma once

/// How many digits a value is written with.

#include <string>
#include <string_view>

#include "daemon/result/evaluation_result.hpp"

namespace fvd {

/// So many digits behind the point that the last is worth no more than a tenth of U, 4 where U is not known: a value
/// has no more digits than it is sure of. A count has none. key: the value's name.
[[nodiscard]] int digits_behind_point(std::string_view key, const EvaluatedValue& value);

/// The number with so many digits behind the point.
[[nodiscard]] std::string fixed_digits(double number, int digits);

}  // namespace fvd
