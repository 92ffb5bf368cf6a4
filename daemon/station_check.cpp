#include "daemon/station_check.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <grp.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/access/address_range.hpp"
#include "daemon/access/role.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// File systems that the kernel makes of itself: whoever may write there makes no files.
constexpr std::pair<long, const char*> kKernelFileSystems[] = {
    {PROC_SUPER_MAGIC, "proc"},      {SYSFS_MAGIC, "sysfs"},     {CGROUP_SUPER_MAGIC, "cgroup"},
    {CGROUP2_SUPER_MAGIC, "cgroup"}, {DEBUGFS_MAGIC, "debugfs"}, {TRACEFS_MAGIC, "tracefs"},
    {SECURITYFS_MAGIC, "securityfs"}};

/// Empty for a place that files can be kept in.
std::string kernel_file_system_of(const fs::path& folder) {
  struct statfs about {};
  if (::statfs(folder.c_str(), &about) != 0) return {};
  const auto* const found = std::find_if(std::begin(kKernelFileSystems), std::end(kKernelFileSystems),
                                         [&about](const auto& kind) { return kind.first == about.f_type; });
  return found == std::end(kKernelFileSystems) ? "" : found->second;
}

/// Of the folder, or of the nearest one above it that is there: that is where it would be made.
std::string folder_problem(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error)) return "'" + there.string() + "' is no folder";
  if (const std::string kind = kernel_file_system_of(there); !kind.empty()) {
    return "'" + there.string() + "' is of the kernel (" + kind + ") and keeps no files; expected a folder on a disk";
  }
  // Rights are the service's, not those of who asks.
  if (::access(there.c_str(), W_OK) == 0 || errno == EACCES) return {};
  return "'" + there.string() + "' cannot be written to: " + std::strerror(errno);
}

void check_recipes(const fs::path& folder, const char* pointer, Problems& problems) {
  try {
    for (const std::string& id : list_recipes(folder)) {
      try {
        (void)read_recipe_file(folder / (id + ".json"));
      } catch (const Error& refused) {
        problems.push_back({pointer, refused.what()});
      }
    }
  } catch (const Error& unreadable) {
    problems.push_back({pointer, unreadable.what()});
  }
}

/// More than these may do is refused already.
void warn_of_open_addresses(const AccessConfig& access, Problems& warnings) {
  for (std::size_t i = 0; i < access.allow.size(); ++i) {
    const AddressRule& rule = access.allow[i];
    const auto range = AddressRange::parse(rule.address);
    if (!range || !range->is_everybody()) continue;
    warnings.push_back({"/rpc/allow/" + std::to_string(i) + "/address",
                        "'" + rule.address + "' gives the role " + std::string(role_name(rule.role)) +
                            " to everybody who reaches the port; name the addresses of the line, or its network"});
  }
}

/// The groups of the defaults are made by the package: who runs the program from a folder needs none.
void warn_of_unknown_groups(const AccessConfig& access, Problems& warnings) {
  const std::vector<GroupRule> usual = AccessConfig{}.groups;
  for (std::size_t i = 0; i < access.groups.size(); ++i) {
    const std::string& name = access.groups[i].group;
    const bool is_usual =
        std::any_of(usual.begin(), usual.end(), [&name](const GroupRule& rule) { return rule.group == name; });
    if (is_usual || ::getgrnam(name.c_str()) != nullptr) continue;
    warnings.push_back({"/rpc/groups/" + std::to_string(i) + "/group",
                        "there is no group '" + name + "' on this machine: nobody has the role " +
                            std::string(role_name(access.groups[i].role)) +
                            " by it, and a group that is made later counts from the next start on"});
  }
}

void warn_of_missing_files(const Config& config, Problems& warnings) {
  const auto is_missing = [](const fs::path& file) {
    std::error_code error;
    return !file.empty() && !fs::exists(file, error) && !error;
  };
  if (const fs::path& file = config.temperature.file; is_missing(file)) {
    warnings.push_back({"/temperature/file", "there is no '" + file.string() +
                                                 "': until it is there, results whose job gives no temperature_c have "
                                                 "none, and the warning temperature_unknown"});
  }
  const StageConfig& stage = config.stage;
  const bool is_on_a_line = stage.driver != "replay" && stage.transport != "tcp";
  if (is_on_a_line && is_missing(stage.serial_device)) {
    warnings.push_back({"/stage/serial_device", "there is no '" + stage.serial_device +
                                                    "': the stage is not ready until it is plugged in; "
                                                    "`ls /dev/serial/by-id` names those that are"});
  }
}

bool can_be_listed(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && ::access(folder.c_str(), R_OK | X_OK) == 0;
}

}  // namespace

StationCheck check_station(const Config& config) {
  StationCheck check;
  Problems& problems = check.problems;
  const PathsConfig& paths = config.paths;
  if (std::string problem = folder_problem(paths.state_dir); !problem.empty()) {
    problems.push_back({"/paths/state_dir", std::move(problem)});
  }
  if (std::string problem = folder_problem(paths.runtime_dir); !problem.empty()) {
    problems.push_back({"/paths/runtime_dir", std::move(problem)});
  }
  check_recipes(paths.recipe_dir, "/paths/recipe_dir", problems);
  if (const fs::path edited = paths.state_dir / "recipes"; can_be_listed(edited)) {
    check_recipes(edited, "/paths/state_dir", problems);
  }
  warn_of_open_addresses(config.rpc.access, check.warnings);
  warn_of_unknown_groups(config.rpc.access, check.warnings);
  warn_of_missing_files(config, check.warnings);
  return check;
}

}  // namespace fvd
