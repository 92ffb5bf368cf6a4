#pragma once

/// Relations between the values of two keys: their test and their words.

#include <string>
#include <string_view>

#include "config/fields.hpp"

namespace fvd {

/// Whether value stands in the relation to bound; false where one of the two is NaN.
[[nodiscard]] bool holds(double value, Relation relation, double bound);

/// "at most slices - 3"
[[nodiscard]] std::string relation_text(Relation relation, std::string_view other, double offset);

}  // namespace fvd
