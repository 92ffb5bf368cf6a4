#pragma once

/// The command `fvdctl measure`: a recipe's evaluation of a surface in a file, without a daemon.

#include <optional>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// The arguments as typed.
struct MeasureArguments {
  std::string source;  ///< folder of a result, or a file of a surface
  std::string recipe;  ///< file
  std::string out;     ///< new folder for evaluation.json; empty = none
  std::vector<double> pitch_um;
  std::string calibration;         ///< folder of calibration.json; empty = none
  std::string objective;           ///< of a surface from elsewhere
  std::optional<double> noise_um;  ///< standard error of every point, where the source has none
  bool json = false;
};

void add_measure_options(CLI::App& command, MeasureArguments& arguments);

/// Prints the values; ends with the exit code of the verdict. Throws UsageError, Error kSurfaceFile, kBadInput,
/// kStorageWrite, kStorageFull. A recipe that is refused, or that measures nothing, is kExitConfig and not thrown.
[[nodiscard]] int run_measure(const MeasureArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
