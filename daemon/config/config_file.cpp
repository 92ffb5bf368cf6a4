#include "daemon/config/config_file.hpp"

#include <algorithm>
#include <optional>
#include <regex>

#include <nlohmann/json.hpp>

#include "config/field_reader.hpp"
#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"

namespace fvd {

namespace {

using nlohmann::json;

const std::filesystem::path kPartFolder = "conf.d";

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

/// From the merged documents to the structure.
void read_merged(LoadedConfig& loaded, const std::filesystem::path& base, const Overrides& overrides) {
  json document = loaded.origins.merged();
  if (document.is_object()) {
    for (const std::string& text : overrides) {
      apply_override(document, text, loaded.problems);
      loaded.origins.add_override(text.substr(0, text.find('=')));
    }
  }
  FieldReader reader(document, loaded.problems);
  describe(loaded.config, reader);
  reader.finish();
  resolve(loaded.config.stage.profile, base);
  resolve(loaded.config.camera.replay_dir, base);
  loaded.config.stage.replay_dir = loaded.config.camera.replay_dir;
  resolve(loaded.config.stage.replay_z_file, base);
  resolve(loaded.config.paths.recipe_dir, base);
  resolve(loaded.config.rpc.access.token_file, base);
}

/// The names of the files *.json in the folder beside the configuration file, in the order in which they are merged.
std::vector<std::filesystem::path> part_files(const std::filesystem::path& folder, Problems& problems) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(".json") && !name.starts_with('.')) files.push_back(entry->path());
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    problems.push_back({"", "cannot list folder '" + folder.string() + "': " + error.message()});
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Reads one file into the origins; a problem if that cannot be. name: as messages call it, empty = the main file.
void add_file(LoadedConfig& loaded, const std::filesystem::path& file, const std::string& name) {
  Problems found;
  std::optional<json> document;
  try {
    document = parse_strict_json(read_text_file(file), found);
  } catch (const Error& error) {
    loaded.problems.push_back({"", error.what()});
    return;
  }
  if (document && !name.empty() && !document->is_object()) {
    found.push_back({"", "is no JSON object; expected e.g. {\"log\": {\"level\": \"debug\"}}"});
  }
  for (const Problem& problem : found) {
    loaded.problems.push_back({"", (name.empty() ? "" : name + ": ") + problem.message});
  }
  if (document) loaded.origins.add_document(name.empty() ? file.string() : name, std::move(*document));
}

/// Names where a value comes from that stands elsewhere than in the main file; empty otherwise.
std::string origin_text(const ConfigOrigins& origins, const std::string& pointer, const std::string& main_file) {
  const std::string origin = origins.of(pointer);
  if (origin.starts_with(kPartFolder.string() + "/")) return "in " + origin + ", beside " + main_file;
  return origin == "--set" ? "from --set" : "";
}

/// Says which of several documents a refused value stands in, and the other values that the message names.
void name_origins(LoadedConfig& loaded, const std::string& main_file) {
  static const std::regex kPointer("/[a-z_]+(/[a-z0-9_]+)+");
  for (Problem& problem : loaded.problems) {
    if (problem.pointer.empty()) continue;
    std::string added;
    const std::string& message = problem.message;
    for (std::sregex_iterator name(message.begin(), message.end(), kPointer), end; name != end; ++name) {
      if (name->str() == problem.pointer) continue;
      const std::string origin = origin_text(loaded.origins, name->str(), main_file);
      if (!origin.empty()) added += " (" + name->str() + " " + origin + ")";
    }
    if (const std::string origin = origin_text(loaded.origins, problem.pointer, main_file); !origin.empty()) {
      added = " (" + origin + ")" + added;
    }
    problem.message += added;
  }
}

/// False where one cannot be read: nothing follows then, as its values are not those that were meant.
bool read_documents(LoadedConfig& loaded, const std::filesystem::path& file, const std::filesystem::path& parts) {
  add_file(loaded, file, "");
  for (const auto& part : part_files(parts, loaded.problems)) {
    add_file(loaded, part, (kPartFolder / part.filename()).string());
  }
  return loaded.problems.empty();
}

/// What is relative to the file, or to the current directory, is so no more: the text may be read from elsewhere.
void make_absolute(Config& config) {
  for (std::filesystem::path* path : {&config.stage.profile, &config.stage.replay_z_file, &config.camera.replay_dir,
                                      &config.paths.recipe_dir, &config.paths.state_dir, &config.paths.runtime_dir,
                                      &config.rpc.socket, &config.rpc.access.token_file, &config.temperature.file}) {
    if (!path->empty()) *path = std::filesystem::absolute(*path).lexically_normal();
  }
}

}  // namespace

LoadedConfig parse_config(std::string_view json_text, const std::filesystem::path& base, const Overrides& overrides) {
  LoadedConfig loaded;
  auto document = parse_strict_json(json_text, loaded.problems);
  if (!document) return loaded;
  loaded.origins.add_document("the file", std::move(*document));
  read_merged(loaded, base, overrides);
  return loaded;
}

LoadedConfig merge_config(const std::filesystem::path& file, const std::filesystem::path& parts,
                          const std::filesystem::path& base, const Overrides& overrides) {
  LoadedConfig loaded;
  if (read_documents(loaded, file, parts)) read_merged(loaded, base, overrides);
  return loaded;
}

LoadedConfig load_config(const std::filesystem::path& file, const Overrides& overrides) {
  LoadedConfig loaded;
  if (!read_documents(loaded, file, file.parent_path() / kPartFolder)) return loaded;
  read_merged(loaded, file.parent_path(), overrides);
  for (Problem& problem : check_config(loaded.config, loaded.problems)) loaded.problems.push_back(std::move(problem));
  name_origins(loaded, file.filename().string());
  return loaded;
}

std::string config_text(Config config) { return fields_to_json(description_of(config)).dump(2) + "\n"; }

std::string config_text_with_origins(LoadedConfig loaded) {
  make_absolute(loaded.config);
  return text_with_origins(fields_to_json(description_of(loaded.config)), loaded.origins);
}

std::string config_schema_text() {
  Config defaults;
  return fields_to_schema(description_of(defaults), "fvd configuration").dump(2) + "\n";
}

}  // namespace fvd
