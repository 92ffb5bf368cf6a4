#pragma once

/// The command `fvdctl process`: arguments in, summary out.

#include <stdexcept>
#include <string>
#include <vector>

#include "core/focus/measure/focus_settings.hpp"
#include "daemon/ctl/fvdctl.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// Arguments that do not go together.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// As typed.
struct ProcessArguments {
  std::string source;
  std::string out;
  std::string part_id;
  std::string z_file;
  std::string z_unit = "um";
  double z_step_um = 0.0;
  double z_start_um = 0.0;
  int window_px = 9;
  int distance_px = 2;
  std::string focus_operator = "modified_laplacian";
  int bin_slices = 1;
  bool stage_correction = false;  ///< recorded z are taken as they are unless asked for
  double min_significance = FocusSettings{}.min_significance;
  double min_prominence = 0.5;
  std::string peak = "five_sample";
  std::vector<std::string> extra_peaks;
  double pixel_pitch_um = 0.0;  ///< 0 = unknown
  int threads = 0;
};

void add_process_options(CLI::App& command, ProcessArguments& arguments);

/// Progress on err, the summary on out. Throws UsageError, Error.
[[nodiscard]] int run_process(const ProcessArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
