#pragma once

/// What the commands of studies share: their jobs, options, and where a study is made. Only sources of this folder
/// include it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/ctl/study_commands.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

struct Desk {
  StudyArguments& a;
  const std::function<RpcClient()> connect;
  const std::string& client;
  const Terminal& terminal;
  std::function<int()>& chosen;
};

template <typename Value>
void put(Json& params, const char* key, const std::optional<Value>& value) {
  if (value) params[key] = *value;
}
void put_evaluated(const StudyArguments& a, Json& params);
void put_region(const StudyArguments& a, Json& params);

/// The jobs given, those of a file, folders of results, or new jobs, which MOVE the stage. Throws UsageError unless it
/// is one of these; what scan_often() throws.
[[nodiscard]] std::vector<std::string> jobs_of(const Desk& desk);

/// Makes the study, of folders without the daemon and without keeping it, prints it, and tells the exit code.
[[nodiscard]] int finish(const Desk& desk, const std::string& method, Json params);

/// A command, and one with --person.
CLI::App* add(CLI::App& parent, const Desk& desk, const char* name, const char* help, std::function<int()> run);
CLI::App* add_asked(CLI::App& parent, const Desk& desk, const char* name, const char* help, std::function<int()> run);

/// How many jobs a study may start for itself, least and most: what it would refuse is refused before anything moves.
struct ScanCounts {
  int least = 1;
  int most = 1000;
};
/// scans: nothing where the study starts no jobs.
void add_job_options(CLI::App& sub, StudyArguments& a, std::optional<ScanCounts> scans = std::nullopt);
void add_value_options(CLI::App& sub, StudyArguments& a);
void add_region_options(CLI::App& sub, StudyArguments& a);
/// For commands whose jobs stand in --step.
void add_offline_option(CLI::App& sub, StudyArguments& a);

}  // namespace fvd::ctl
