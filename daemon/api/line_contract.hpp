#pragma once

/// In which order and how patiently the program of a line speaks to fvd, for rpc.discover and daemon/README.md.

#include <string>

#include <nlohmann/json.hpp>

namespace fvd {

/// {"order": [...], "times": {key: {"value", "meaning"}}}
[[nodiscard]] nlohmann::ordered_json line_contract_json();
/// The same as a list and a table.
[[nodiscard]] std::string line_contract_markdown();

}  // namespace fvd
