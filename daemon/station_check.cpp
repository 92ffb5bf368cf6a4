#include "daemon/station_check.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include <unistd.h>

#include "core/base/error.hpp"
#include "daemon/recipes/recipe_folder.hpp"
#include "daemon/recipes/recipe_masks.hpp"

namespace fvd {

namespace {

namespace fs = std::filesystem;

/// Of the folder, or of the nearest one above it that is there: that is where it would be made.
std::string folder_problem(const fs::path& folder) {
  std::error_code error;
  fs::path there = fs::absolute(folder, error);
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error)) return "'" + there.string() + "' is no folder";
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

bool can_be_listed(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && ::access(folder.c_str(), R_OK | X_OK) == 0;
}

}  // namespace

Problems check_station(const Config& config) {
  Problems problems;
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
  return problems;
}

}  // namespace fvd
