#include "daemon/ctl/pitch_option.hpp"

#include <CLI/CLI.hpp>

#include "daemon/ctl/process_command.hpp"
#include "daemon/ctl/readable_range.hpp"

namespace fvd::ctl {

void add_pitch_option(CLI::App& command, std::vector<double>& pitch_um) {
  command
      .add_option("--pitch-um", pitch_um,
                  "distance of the points, or X,Y of columns and rows, where the source does not tell it")
      ->delimiter(',')
      ->check(PositiveCheck());
}

SurfaceReadOptions read_options(const std::vector<double>& pitch_um) {
  if (pitch_um.size() > 2) throw UsageError("--pitch-um takes one distance, or those of columns and rows");
  SurfaceReadOptions options;
  if (pitch_um.empty()) return options;
  options.pitch_x_um = pitch_um.front();
  options.pitch_y_um = pitch_um.back();
  return options;
}

}  // namespace fvd::ctl
