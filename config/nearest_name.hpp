#pragma once

/// What somebody may have meant by an unknown name.

#include <string>
#include <string_view>
#include <vector>

namespace fvd {

/// "; did you mean 'NAME'?" with the known name that takes the fewest letters changed, added or left out, else with
/// up to three that begin with the whole name, as where a unit is left out; empty where all are too different, and for
/// a name of more than 128 bytes.
[[nodiscard]] std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

}  // namespace fvd
