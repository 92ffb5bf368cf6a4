#pragma once

/// The reasons of holes as recipes name them.

#include <string>
#include <vector>

#include "core/surface/mask_reason.hpp"

namespace fvd {

/// "low_prominence", "first_slice", ... as result.json counts them.
[[nodiscard]] std::vector<std::string> reason_names();

/// The bits of all these names; a name that is none counts for nothing.
[[nodiscard]] MaskReasons reason_bits(const std::vector<std::string>& names);

}  // namespace fvd
