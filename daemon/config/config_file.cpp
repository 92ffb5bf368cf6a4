#include "daemon/config/config_file.hpp"

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"

namespace fvd {

namespace {

using nlohmann::json;

auto description_of(Config& config) {
  return [&config](Fields& fields) { describe(config, fields); };
}

/// Puts the value of one "a.b=VALUE" into the document, making the objects on the way.
void apply_override(json& document, const std::string& text, Problems& problems) {
  const auto refuse = [&](const std::string& why) { problems.push_back({"", "--set " + text + ": " + why}); };
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals);
  if (equals == std::string::npos || key.empty() || key.front() == '.' || key.back() == '.' ||
      key.find("..") != std::string::npos) {
    return refuse("expected group.key=value, e.g. rpc.port=7411");
  }
  json* place = &document;
  std::size_t begin = 0;
  for (auto dot = key.find('.'); dot != std::string::npos; begin = dot + 1, dot = key.find('.', begin)) {
    place = &(*place)[key.substr(begin, dot - begin)];
    if (place->is_null()) *place = json::object();
    if (!place->is_object()) return refuse("'" + key.substr(0, dot) + "' is no group");
  }
  const std::string value = text.substr(equals + 1);
  Problems no_json;
  const auto parsed = parse_strict_json(value, no_json, JsonComments::kRefused);
  (*place)[key.substr(begin)] = parsed ? *parsed : json(value);
}

void resolve(std::filesystem::path& path, const std::filesystem::path& base) {
  if (!path.empty() && path.is_relative()) path = (base / path).lexically_normal();
}

}  // namespace

LoadedConfig parse_config(std::string_view json_text, const std::filesystem::path& base, const Overrides& overrides) {
  LoadedConfig loaded;
  auto document = parse_strict_json(json_text, loaded.problems);
  if (!document) return loaded;
  if (document->is_object()) {
    for (const std::string& text : overrides) apply_override(*document, text, loaded.problems);
  }
  FieldReader reader(*document, loaded.problems);
  describe(loaded.config, reader);
  reader.finish();
  resolve(loaded.config.stage.profile, base);
  resolve(loaded.config.camera.replay_dir, base);
  loaded.config.stage.replay_dir = loaded.config.camera.replay_dir;
  resolve(loaded.config.stage.replay_z_file, base);
  resolve(loaded.config.paths.recipe_dir, base);
  resolve(loaded.config.rpc.access.token_file, base);
  return loaded;
}

LoadedConfig load_config(const std::filesystem::path& file, const Overrides& overrides) {
  LoadedConfig loaded;
  try {
    loaded = parse_config(read_text_file(file), file.parent_path(), overrides);
  } catch (const Error& error) {
    loaded.problems.push_back({"", error.what()});
    return loaded;
  }
  for (Problem& problem : check_config(loaded.config, loaded.problems)) loaded.problems.push_back(std::move(problem));
  return loaded;
}

std::string config_text(Config config) { return fields_to_json(description_of(config)).dump(2) + "\n"; }

std::string config_schema_text() {
  Config defaults;
  return fields_to_schema(description_of(defaults), "fvd configuration").dump(2) + "\n";
}

}  // namespace fvd
