#pragma once

/// The other two uses of a description: the structure as JSON, and the JSON schema it follows.

#include <string>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"

namespace fvd {

/// The values in the order of the description; reading them back gives the same structure.
[[nodiscard]] nlohmann::ordered_json fields_to_json(const std::function<void(Fields&)>& describe);

/// JSON Schema draft 7 of the description, with the values as defaults. Unknown keys are refused.
[[nodiscard]] nlohmann::ordered_json fields_to_schema(const std::function<void(Fields&)>& describe,
                                                      const std::string& title);

}  // namespace fvd
