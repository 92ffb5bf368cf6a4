#include "tests/bench/watched_daemon.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fstream>
#include <optional>
#include <regex>
#include <thread>

#include <nlohmann/json.hpp>

namespace fvd::bench {

namespace {

std::vector<std::string> command_of(const std::filesystem::path& program, const std::filesystem::path& runtime_dir,
                                    const std::vector<std::string>& settings,
                                    const std::vector<std::string>& environment) {
  std::vector<std::string> command{"env"};
  command.insert(command.end(), environment.begin(), environment.end());
  command.insert(command.end(), {program.string(), "--config", FVD_SOURCE_DIR "/config/fvd-sim.json"});
  for (const std::string& setting : settings) {
    command.emplace_back("--set");
    command.push_back(setting);
  }
  command.emplace_back("--set");
  command.push_back("paths.runtime_dir=" + runtime_dir.string());
  return command;
}

/// "2026-11-28 17:00:00.123", local time.
WallTime time_of(const std::string& text) {
  std::tm parts{};
  ::strptime(text.c_str(), "%Y-%m-%d %H:%M:%S", &parts);
  parts.tm_isdst = -1;
  return std::chrono::system_clock::from_time_t(std::mktime(&parts)) +
         std::chrono::milliseconds(std::stoi(text.substr(text.size() - 3)));
}

}  // namespace

WatchedDaemon::WatchedDaemon(const std::filesystem::path& program, const std::filesystem::path& runtime_dir,
                             const std::vector<std::string>& settings, const std::vector<std::string>& environment)
    : port_file_(runtime_dir / "rpc.json"),
      process_((std::filesystem::remove(port_file_), command_of(program, runtime_dir, settings, environment))),
      reader_(start_thread("log-reader", [this](const std::stop_token&) { read_log(); })) {
  add(std::chrono::system_clock::now(), "started");
}

WatchedDaemon::~WatchedDaemon() { process_.signal(SIGTERM); }

int WatchedDaemon::await_port(std::chrono::seconds within) const {
  const auto deadline = std::chrono::steady_clock::now() + within;
  while (std::chrono::steady_clock::now() < deadline) {
    std::ifstream in(port_file_);
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (json.is_object()) return json.value("port", 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return 0;
}

void WatchedDaemon::kill() {
  process_.signal(SIGKILL);
  (void)process_.wait();
  add(std::chrono::system_clock::now(), "killed");
}

std::vector<LoggedChange> WatchedDaemon::changes() const {
  const MutexLock lock(mutex_);
  auto sorted = changes_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return sorted;
}

void WatchedDaemon::add(WallTime at, std::string what) {
  const MutexLock lock(mutex_);
  changes_.push_back({at, std::move(what)});
}

void WatchedDaemon::read_log() {
  static const std::regex kChange(
      R"(\[([0-9-]+ [0-9:.]+)\].*(?:state \w+ -> (\w+)|(part_release (?:true|false)))\b.*)");
  for (std::string line = process_.line(); !line.empty(); line = process_.line()) {
    std::smatch found;
    if (std::regex_match(line, found, kChange)) add(time_of(found[1]), found[2].matched ? found[2] : found[3]);
  }
}

std::vector<Interval> released_intervals(const std::vector<LoggedChange>& changes) {
  const bool logs_release = std::any_of(changes.begin(), changes.end(), [](const LoggedChange& change) {
    return change.what.rfind("part_release", 0) == 0;
  });
  std::vector<Interval> intervals;
  std::optional<WallTime> since;
  for (const LoggedChange& change : changes) {
    const bool free =
        logs_release ? change.what == "part_release true" : change.what != "executing" && change.what != "killed";
    const bool tells = !logs_release || change.what.rfind("part_release", 0) == 0 || change.what == "killed";
    if (!tells) continue;
    if (free && !since) since = change.at;
    if (!free && since) {
      intervals.push_back({*since, change.at});
      since.reset();
    }
  }
  return intervals;
}

}  // namespace fvd::bench
