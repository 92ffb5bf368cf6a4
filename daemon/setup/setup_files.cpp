#include "daemon/setup/setup_files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/config/config_file.hpp"
#include "daemon/export/durable_file.hpp"

namespace fvd {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json camera_keys(const SetupDraft& draft) {
  const CameraConfig& camera = draft.devices.camera;
  ordered_json keys{{"driver", camera.driver},
                    {"address", camera.address},
                    {"mirror_x", camera.mirror_x},
                    {"mirror_y", camera.mirror_y}};
  if (!camera.packet_socket) keys["packet_socket"] = false;
  if (camera.simulated) keys["simulated"] = true;
  return keys;
}

ordered_json stage_keys(const SetupDraft& draft) {
  const StageConfig& stage = draft.devices.stage;
  ordered_json keys{{"driver", stage.driver}, {"transport", stage.transport}};
  if (stage.transport == "tcp") {
    keys["address"] = stage.address;
    keys["port"] = stage.port;
  } else {
    keys["serial_device"] = stage.serial_device;
    keys["serial_baud"] = stage.serial_baud;
    if (stage.driver == "modbus") keys["serial_parity"] = stage.serial_parity;
  }
  if (stage.driver == "modbus") {
    keys["profile"] = stage.profile.string();
    keys["unit"] = stage.unit;
  } else {
    keys["gcs_axis"] = stage.gcs_axis;
  }
  keys["min_um"] = stage.min.value;
  keys["max_um"] = stage.max.value;
  keys["reversed"] = stage.reversed;
  if (stage.simulated) keys["simulated"] = true;
  return keys;
}

/// The older file's keys, or none. One that cannot be read is not built upon.
ordered_json older_keys(const fs::path& file) {
  if (!fs::exists(file)) return ordered_json::object();
  Problems problems;
  const auto before = parse_strict_json(read_text_file(file), problems);
  if (!before || !before->is_object()) return ordered_json::object();
  ordered_json keys = ordered_json::object();
  for (const auto& [key, value] : before->items()) keys[key] = value;
  return keys;
}

std::string config_document(const SetupDraft& draft, const fs::path& file) {
  ordered_json document = older_keys(file);
  document["camera"].update(camera_keys(draft));
  document["stage"].update(stage_keys(draft));
  if (!document.contains("paths") || !document["paths"].contains("recipe_dir")) {
    document["paths"]["recipe_dir"] = "recipes";
  }
  return document.dump(2) + "\n";
}

[[noreturn]] void fail(const std::string& what, const fs::path& file) {
  throw Error(ErrorCode::kStorageWrite, what + " " + file.string() + ": " + std::strerror(errno));
}

/// A second name for the file that is there. Returns it.
fs::path keep_older(const fs::path& file) {
  for (int i = 1;; ++i) {
    const fs::path kept = file.string() + ".old-" + std::to_string(i);
    if (::link(file.c_str(), kept.c_str()) == 0) return kept;
    if (errno != EEXIST) fail("cannot keep the older file as", kept);
  }
}

/// Puts the new file in place: by a rename, or under a name that must be free.
void put_in_place(const fs::path& made, const fs::path& file, bool replace) {
  const int failed = replace ? std::rename(made.c_str(), file.c_str()) : ::link(made.c_str(), file.c_str());
  const int reason = errno;
  if (!replace || failed != 0) ::unlink(made.c_str());
  errno = reason;
  if (failed != 0) fail("cannot write", file);
  sync_directory(file.parent_path());
}

fs::path write_recipe(const SetupDraft& draft, const fs::path& folder) {
  for (int i = 1;; ++i) {
    const fs::path file = folder / (i == 1 ? "first.json" : "first-" + std::to_string(i) + ".json");
    if (fs::exists(file)) continue;
    write_new_file(file, trial_recipe(draft, *draft.trial));
    sync_directory(folder);
    return file;
  }
}

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

std::string write_setup(const SetupDraft& draft, const fs::path& named, bool replace) {
  const fs::path file = fs::absolute(named).lexically_normal();
  const bool there = fs::exists(file);
  if (there && !replace) {
    throw Error(ErrorCode::kBadInput, file.string() + " is there already and stays as it is: 'replace' keeps it as " +
                                          file.filename().string() + ".old-N, or write another");
  }
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const std::string text = config_document(draft, file);
  LoadedConfig loaded = parse_config(text, file.parent_path());
  if (loaded.problems.empty()) fs::create_directories(loaded.config.paths.recipe_dir, error);
  for (Problem& problem : check_config(loaded.config, loaded.problems)) loaded.problems.push_back(std::move(problem));
  throw_if_any(loaded.problems, ErrorCode::kBadConfig, file.string());

  const fs::path made = file.string() + ".new-" + std::to_string(::getpid());
  fs::remove(made, error);
  write_new_file(made, text);
  std::string told = "the configuration is " + file.string();
  if (there) told += ", the older one " + keep_older(file).string();
  put_in_place(made, file, there);
  if (draft.trial) told += ", the recipe " + write_recipe(draft, loaded.config.paths.recipe_dir).string();
  return told;
}

}  // namespace fvd
