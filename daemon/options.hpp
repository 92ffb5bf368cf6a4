#pragma once

/// The command line of fvd.

#include <filesystem>
#include <optional>

#include "daemon/config_file.hpp"

namespace fvd {

/// Exit codes of fvd and fvdctl (sysexits.h).
namespace exit_code {
inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 64;
inline constexpr int kBadData = 65;
inline constexpr int kUnavailable = 69;
inline constexpr int kInternal = 70;
inline constexpr int kIo = 74;
inline constexpr int kConfig = 78;
}  // namespace exit_code

struct Options {
  std::filesystem::path config_file = "/etc/fvd/fvd.json";
  Overrides overrides;
  bool check_config = false;
  bool dump_config = false;
  bool print_schema = false;
};

/// The options, or the exit code where the command line says it all (--help, --version) or is wrong.
struct ParsedOptions {
  Options options;
  std::optional<int> exit;
};
[[nodiscard]] ParsedOptions parse_options(int argc, char** argv);

}  // namespace fvd
