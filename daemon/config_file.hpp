#pragma once

/// The configuration file: reading, checking, showing.

#include <filesystem>
#include <string>
#include <vector>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "daemon/config.hpp"

namespace fvd {

/// Every key with its range and meaning.
void describe(Config& config, Fields& fields);

/// One "--set group.key=value": the value is JSON, or a text where that is no JSON.
using Overrides = std::vector<std::string>;

struct LoadedConfig {
  Config config;
  Problems problems;  ///< empty = usable
};

/// Reads the file, applies the overrides, checks ranges and what must fit together. Relative paths of profile and recipes
/// are relative to the file, those of state_dir and runtime_dir to the current directory. Never throws.
[[nodiscard]] LoadedConfig load_config(const std::filesystem::path& file, const Overrides& overrides);

/// The configuration in force, as JSON text.
[[nodiscard]] std::string config_text(Config config);
/// The JSON schema of the file; config/fvd.schema.json is this text.
[[nodiscard]] std::string config_schema_text();

}  // namespace fvd
