#pragma once

/// The other uses of a description: the structure as JSON, the JSON schema it follows, and the table people read.

#include <string>

#include <nlohmann/json.hpp>

#include "config/fields.hpp"

namespace fvd {

/// The values in the order of the description; reading them back gives the same structure.
[[nodiscard]] nlohmann::ordered_json fields_to_json(const std::function<void(Fields&)>& describe);

/// JSON Schema draft 7 of the description, with the values as defaults. Unknown keys are refused.
[[nodiscard]] nlohmann::ordered_json fields_to_schema(const std::function<void(Fields&)>& describe,
                                                      const std::string& title);

/// A schema's keys as a Markdown table: key, accepted, default, meaning; a row per value, groups by "group.key".
[[nodiscard]] std::string schema_to_table(const nlohmann::ordered_json& schema);

}  // namespace fvd
