#pragma once

/// The configuration file: reading, checking, showing.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"
#include "config/problem.hpp"
#include "daemon/config/config.hpp"
#include "daemon/config/config_origins.hpp"

namespace fvd {

/// Every key with its range and meaning; those of camera and stage by drivers/registry.
void describe(Config& config, Fields& fields);

/// Each "group.key=value" as given to --set; the value is JSON, or a text where that is no JSON.
using Overrides = std::vector<std::string>;

struct LoadedConfig {
  Config config;
  Problems problems;      ///< empty = usable
  ConfigOrigins origins;  ///< of every value
};

/// Text to structure: overrides are applied, then types, ranges and names are checked. Keys that are absent or refused
/// have their default. base: the file's folder, against which profile, replay_dir, recipe_dir and token_file are taken
/// if relative; state_dir and runtime_dir stay relative to the current directory. Never throws for bad input.
[[nodiscard]] LoadedConfig parse_config(std::string_view json_text, const std::filesystem::path& base,
                                        const Overrides& overrides = {});

/// What must fit together or exist on this machine, beyond the range of a single key. read: the problems
/// of reading it; what rests on a value that they are about is not judged. No device is touched.
[[nodiscard]] Problems check_config(const Config& config, const Problems& read = {});

/// Reads the file and merges the folder `parts` into it as load_config() does, and does the first of the above alone.
[[nodiscard]] LoadedConfig merge_config(const std::filesystem::path& file, const std::filesystem::path& parts,
                                        const std::filesystem::path& base, const Overrides& overrides = {});

/// Reads the file and merges into it what lies in the folder conf.d beside it (RFC 7396): every *.json in the order of
/// the names' bytes, files that begin with a dot left out. Then does both of the above. A file that cannot be read is a
/// problem, and the only one told then.
[[nodiscard]] LoadedConfig load_config(const std::filesystem::path& file, const Overrides& overrides = {});

/// The configuration in force, as JSON text.
[[nodiscard]] std::string config_text(Config config);
/// The same with the origin of every value in a comment behind it, and absolute paths: load_config() reads it anywhere.
[[nodiscard]] std::string config_text_with_origins(LoadedConfig loaded);
/// JSON Schema of the file; config/fvd.schema.json is this text.
[[nodiscard]] std::string config_schema_text();

}  // namespace fvd
