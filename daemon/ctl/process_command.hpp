#pragma once

/// The command `fvdctl process`: arguments in, summary out.

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/ctl/fvdctl.hpp"
#include "drivers/replay/slice_files.hpp"

namespace CLI {
class App;
}

namespace fvd::ctl {

/// An argument is missing, or two contradict each other.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The arguments as typed. An absent one leaves the value of the recipe, or the default of recipes.
struct ProcessArguments {
  std::string source;
  std::string out;
  std::string part_id;
  std::string recipe;  ///< file; empty = the defaults of recipes, and the stage is not corrected
  StackChoice choice;
  std::optional<int> significant_bits;  ///< of 16; absent: seen from the levels
  std::string z_file;
  std::optional<std::string> z_unit;  ///< of z_file; absent = um
  std::optional<double> z_step_um;
  std::optional<double> z_start_um;
  std::optional<int> window_px;
  std::optional<int> distance_px;
  std::optional<std::string> focus_operator;
  std::optional<std::string> window;
  std::optional<double> smooth_px;
  std::optional<int> bin_slices;
  bool stage_correction = false;
  std::optional<double> min_significance;
  std::optional<double> min_prominence;
  std::optional<double> broad_curve;
  std::optional<double> narrow_curve;
  std::optional<double> second_peak;
  std::optional<double> clipped_share;
  std::optional<int> edge_band_slices;
  std::optional<double> max_sigma_um;
  std::optional<std::string> peak;
  std::vector<std::string> extra_peaks;
  std::optional<double> pixel_pitch_um;
  std::optional<int> allowed_lost_slices;
  std::optional<std::string> drift;  ///< "auto" or "off"; absent = as the recipe says
  int threads = 0;
};

/// --pattern, --channel and --time.
void add_choice_options(CLI::App& command, StackChoice& choice);

void add_process_options(CLI::App& command, ProcessArguments& arguments);

/// Progress on err, the summary on out; kExitVerdictFail where the recipe's limits are not met. Throws UsageError,
/// Error.
[[nodiscard]] int run_process(const ProcessArguments& arguments, const Terminal& terminal);

}  // namespace fvd::ctl
