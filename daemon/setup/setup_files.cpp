#include "daemon/setup/setup_files.hpp"

#include <cerrno>
#include <set>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "config/field_writer.hpp"
#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/export/durable_file.hpp"
#include "daemon/export/file_calls.hpp"
#include "daemon/export/storage_error.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// What the setup settled, beside keys that differ from their defaults.
std::set<std::string> settled(const StageConfig& stage) {
  std::set<std::string> keys{"driver",    "transport",  "min_um",
                             "max_um",    "take_up_um", "speed_um_per_s",
                             "simulated", "reversed",   "acceleration_um_per_s2"};
  keys.merge(stage.transport == "tcp" ? std::set<std::string>{"address", "port"}
                                      : std::set<std::string>{"serial_device", "serial_baud"});
  keys.merge(stage.driver == "modbus" ? std::set<std::string>{"profile", "unit"} : std::set<std::string>{"gcs_axis"});
  if (stage.transport == "rtu") keys.insert("serial_parity");
  return keys;
}
std::set<std::string> settled(const CameraConfig& /*camera*/) {
  return {"driver", "address", "serial", "packet_socket", "mirror_x", "mirror_y", "simulated"};
}

/// Keys and values of both devices.
ordered_json values_of(DeviceConfigs devices) {
  return fields_to_json([&devices](Fields& fields) { describe(devices, fields); });
}

bool is_there(const fs::path& file) {
  std::error_code error;
  const bool there = fs::exists(fs::symlink_status(file, error));
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory) {
    throw Error(ErrorCode::kStorageWrite, "cannot look for " + file.string() + ": " + error.message());
  }
  return there;
}

/// The older file's keys, or none. One that cannot be read is not built upon.
ordered_json older_keys(const fs::path& file) {
  if (!is_there(file)) return ordered_json::object();
  Problems problems;
  const auto before = parse_strict_json(read_text_file(file), problems);
  if (!before || !before->is_object()) return ordered_json::object();
  ordered_json keys = ordered_json::object();
  for (const auto& [key, value] : before->items()) keys[key] = value;
  return keys;
}

/// A block of the document, made where there is none; nothing where something else stands in its place, which reading
/// the document will refuse.
ordered_json* block_of(ordered_json& document, const char* name) {
  ordered_json& block = document[name];
  if (block.is_null()) block = ordered_json::object();
  return block.is_object() ? &block : nullptr;
}

/// Every value that was in force takes the place of the older one: nothing is left over that the trial did not see.
void put_values(ordered_json* block, const ordered_json& values, const ordered_json& defaults,
                const std::set<std::string>& always) {
  if (block == nullptr) return;
  for (const auto& [key, value] : values.items()) {
    if (always.contains(key) || block->contains(key) || value != defaults.at(key)) (*block)[key] = value;
  }
}

std::string config_document(const SetupDraft& draft, const fs::path& file) {
  ordered_json document = older_keys(file);
  const ordered_json values = values_of(draft.devices);
  const ordered_json defaults = values_of({});
  put_values(block_of(document, "camera"), values["camera"], defaults["camera"], settled(draft.devices.camera));
  put_values(block_of(document, "stage"), values["stage"], defaults["stage"], settled(draft.devices.stage));
  ordered_json* const paths = block_of(document, "paths");
  if (paths != nullptr && !paths->contains("recipe_dir")) (*paths)["recipe_dir"] = "recipes";
  return document.dump(2) + "\n";
}

/// A copy of the file that is there, under a name that is free. Returns it.
fs::path keep_older(const fs::path& file) {
  for (int i = 1;; ++i) {
    const fs::path kept = file.string() + ".old-" + std::to_string(i);
    if (is_there(kept)) continue;
    write_new_file(kept, read_text_file(file));
    return kept;
  }
}

fs::path write_recipe(const SetupDraft& draft, const fs::path& folder) {
  for (int i = 1;; ++i) {
    const fs::path file = folder / (i == 1 ? "first.json" : "first-" + std::to_string(i) + ".json");
    if (is_there(file)) continue;
    write_new_file(file, trial_recipe(draft, *draft.trial));
    sync_directory(folder);
    return file;
  }
}

/// Files that are removed again where not all of them could be written.
struct LeftOver {
  LeftOver() = default;
  LeftOver(const LeftOver&) = delete;
  LeftOver& operator=(const LeftOver&) = delete;
  ~LeftOver() {
    for (const fs::path& file : files) file_calls().unlink(file);
  }
  std::vector<fs::path> files;
};

}  // namespace

std::string trial_recipe(const SetupDraft& draft, const TrialRange& range) {
  const double pitch_um = draft.pixel_pitch_um.value_or(1.0);
  const ordered_json recipe{
      {"format", 2},
      {"description", std::string("Trial scan of the setup") +
                          (draft.pixel_pitch_um ? "" : "; the pixel pitch is not known, 1 um stands for it")},
      {"acquire",
       {{"scan", {{"start_um", range.start_um}, {"step_um", range.step_um}, {"slices", range.slices}}},
        {"camera", {{"exposure_us", draft.picture.exposure_us}}}}},
      {"reconstruct", {{"lateral", {{"pixel_pitch_x_um", pitch_um}, {"pixel_pitch_y_um", pitch_um}}}}}};
  return recipe.dump(2) + "\n";
}

DeviceConfigs older_devices(const fs::path& named) {
  const fs::path file = fs::absolute(named).lexically_normal();
  try {
    if (is_there(file)) return parse_config(read_text_file(file), file.parent_path()).config;
  } catch (const Error&) {  // told when it is to be replaced
  }
  return {};
}

std::string write_setup(const SetupDraft& draft, const fs::path& named, bool replace) {
  const fs::path file = fs::absolute(named).lexically_normal();
  const bool there = is_there(file);
  if (there && !replace) {
    throw Error(ErrorCode::kBadInput, file.string() + " is there already and stays as it is: 'replace' keeps it as " +
                                          file.filename().string() + ".old-N, or write another");
  }
  (void)make_directories(file.parent_path());
  const std::string text = config_document(draft, file);
  LoadedConfig loaded = parse_config(text, file.parent_path());
  if (loaded.problems.empty()) (void)make_directories(loaded.config.paths.recipe_dir);
  for (Problem& problem : check_config(loaded.config, loaded.problems)) loaded.problems.push_back(std::move(problem));
  throw_if_any(loaded.problems, ErrorCode::kBadConfig, file.string());

  // The configuration last: where it is, all that belongs to it is.
  LeftOver left_over;
  fs::path recipe;
  if (draft.trial) left_over.files.push_back(recipe = write_recipe(draft, loaded.config.paths.recipe_dir));
  const fs::path made = file.string() + ".new-" + std::to_string(::getpid());
  remove_file(made);  // of a try that could not clear up
  write_new_file(made, text);
  left_over.files.push_back(made);
  fs::path kept;
  if (there) left_over.files.push_back(kept = keep_older(file));
  const int put = there ? file_calls().rename(made, file) : file_calls().rename_to_new(made, file);
  if (put != 0) throw storage_error(errno, "write", file);
  left_over.files.clear();
  sync_directory(file.parent_path());
  std::string told = "the configuration is " + file.string();
  if (there) told += ", the older one " + kept.string();
  if (draft.trial) told += ", the recipe " + recipe.string();
  return told;
}

}  // namespace fvd
