#include "daemon/config_reload.hpp"

#include <algorithm>
#include <iterator>

#include <nlohmann/json.hpp>

namespace fvd {

namespace {

using nlohmann::json;

constexpr const char* kReloadable[] = {"/log/level", "/store/keep_days", "/store/keep_gib", "/store/keep_free_gib"};

bool is_reloadable(const std::string& pointer) {
  return std::find(std::begin(kReloadable), std::end(kReloadable), pointer) != std::end(kReloadable);
}

}  // namespace

Reload plan_reload(const Config& running, const LoadedConfig& wanted) {
  Reload reload;
  if (!wanted.problems.empty()) {
    reload.refusal = to_text(wanted.problems, "configuration");
    return reload;
  }
  const json before = json::parse(config_text(running));
  const json after = json::parse(config_text(wanted.config));
  std::string needs_start;
  for (const json& step : json::diff(before, after)) {
    const auto pointer = step["path"].get<std::string>();
    if (!is_reloadable(pointer)) {
      needs_start += (needs_start.empty() ? "" : ", ") + pointer;
      continue;
    }
    const json::json_pointer place(pointer);
    const auto text = [&place](const json& config) {
      const json& value = config[place];
      return value.is_string() ? value.get<std::string>() : value.dump();
    };
    reload.changes.push_back(pointer + ": " + text(before) + " -> " + text(after));
  }
  if (!needs_start.empty()) {
    reload.refusal = "changed keys that only a restart takes: " + needs_start;
    reload.changes.clear();
  }
  return reload;
}

}  // namespace fvd
