#pragma once

/// The command `fvdctl export`: the surface of a result or of a file in another format, without a daemon.

#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// The arguments as typed.
struct ExportArguments {
  std::string source;  ///< folder of a result, or a file of a surface
  std::string format;
  std::string out;
  std::vector<double> pitch_um;  ///< of columns and rows, or one of both; empty = as the source tells
};

void add_export_options(CLI::App& command, ExportArguments& arguments);

/// Writes the file and says on out what it holds. Throws UsageError, Error kSurfaceFile, kBadInput, kStorageWrite,
/// kStorageFull.
[[nodiscard]] int run_export(const ExportArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
