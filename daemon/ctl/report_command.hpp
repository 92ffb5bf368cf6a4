#pragma once

/// The command `fvdctl report`: the report of a result's folder, without a daemon.

#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// The arguments as typed.
struct ReportArguments {
  std::string source;  ///< folder of a result
  std::string out;
  std::vector<double> pitch_um;  ///< of columns and rows, or one of both; empty = as the result tells
};

void add_report_options(CLI::App& command, ReportArguments& arguments);

/// Writes the PDF and says on out what it tells. Throws UsageError, Error kSurfaceFile, kStorageWrite, kStorageFull,
/// kInternal.
[[nodiscard]] int run_report(const ReportArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
