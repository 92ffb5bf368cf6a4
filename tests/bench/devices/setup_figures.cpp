/// Sets up eight simulated stations, every way in which axis and camera can be built, and measures the letter F on each
/// with the daemon and the files that the setup wrote. Prints one JSON object in the last line.

#include <cstdio>
#include <iostream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "daemon/app.hpp"
#include "daemon/config/config_file.hpp"
#include "sim/evaluate/evaluate.hpp"
#include "tests/support/line_client.hpp"
#include "tests/support/scratch_dir.hpp"
#include "tests/support/set_up_station.hpp"

namespace fvd::bench {
namespace {

using nlohmann::json;

/// A letter that lies elsewhere, or below its land, is 20 um wrong over a fifth of the picture.
constexpr double kMostRms_um = 1.0;
constexpr double kLeastValid = 0.8;

json ask(int port, const std::string& method, const json& params, std::chrono::seconds within) {
  LineClient client(port);
  client.send(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump() + "\n");
  const auto line = client.line(within);
  return line ? json::parse(*line).value("result", json()) : json();
}

/// Figures of a scan by the written files; empty where there was none.
json measured(const std::filesystem::path& config_file, const std::filesystem::path& folder) {
  const LoadedConfig loaded =
      load_config(config_file, {"rpc.port=0", "log.level=warn", "paths.state_dir=" + (folder / "state").string(),
                                "paths.runtime_dir=" + (folder / "run").string()});
  if (!loaded.problems.empty()) return {};
  App app(loaded.config);
  const int port = app.rpc_port();
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  const auto ready = [&] {
    return ask(port, "system.state", json::object(), std::chrono::seconds(10)).value("ready", false);
  };
  while (!ready() && std::chrono::steady_clock::now() < until) std::this_thread::yield();
  (void)ask(port, "job.start", {{"seq", 1}, {"part_id", "F"}, {"recipe", "first"}}, std::chrono::seconds(10));
  (void)ask(port, "job.wait", {{"seq", 1}}, std::chrono::seconds(120));
  const json result = ask(port, "result.get", {{"seq", 1}, {"format", "full"}}, std::chrono::seconds(10));
  if (!result.contains("directory")) return {};
  std::ostringstream text;
  sim::evaluate(test::letter_f_world(), result["directory"].get<std::string>(), true, text);
  const std::string all = text.str();
  const std::string last = all.substr(all.rfind('\n', all.size() - 2) + 1);
  return json::parse(last);
}

int run() {
  spdlog::set_level(spdlog::level::warn);
  int right = 0;
  int unattended = 0;
  for (const test::Built& built : test::all_ways_to_build()) {
    sim::Plant plant(test::letter_f_station(built));
    const test::ScratchDir folder;
    const SetupOptions options{folder / "fvd.json", FVD_SOURCE_DIR "/config/drives", folder.path(), true, {}};
    const test::SetUp result = test::set_up(plant, options, FVD_SOURCE_DIR "/config/drives/oriental-az.json");
    unattended += result.unattended_moves;
    const json figures = result.done ? measured(result.written, folder.path()) : json();
    const bool is_right =
        figures.is_object() && figures.value("rms_um", 1e9) < kMostRms_um && figures.value("valid", 0.0) > kLeastValid;
    right += is_right ? 1 : 0;
    std::cout << "axis " << (built.reversed ? "reversed" : "straight") << ", camera"
              << (built.mirror.x ? " mirrored in x" : "") << (built.mirror.y ? " mirrored in y" : "")
              << (built.mirror.any() ? "" : " straight") << ": " << (is_right ? "right " : "WRONG ") << figures.dump()
              << std::endl;
    if (!is_right) std::cout << result.log << std::flush;
  }
  std::cout << json{{"setup_unattended_moves", unattended}, {"setup_right_of_8", right}}.dump() << std::endl;
  return unattended == 0 && right == 8 ? 0 : 1;
}

}  // namespace
}  // namespace fvd::bench

int main() try { return fvd::bench::run(); } catch (const std::exception& error) {
  std::fprintf(stderr, "setup_figures: %s\n", error.what());
  return 70;
}
