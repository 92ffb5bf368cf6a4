#pragma once

/// `fvdctl suggest --na --wavelength-nm`: a recipe's keys for stacks of a confocal microscope.

#include <CLI/CLI.hpp>

#include "daemon/ctl/fvdctl.hpp"

namespace fvd::ctl {

struct ConfocalOptics {
  double na = 0.0;             ///< 0 = not given
  double wavelength_nm = 0.0;  ///< in vacuum
  double index = 1.0;          ///< of what is between lens and surface
};

/// In place of the source.
void add_confocal_options(CLI::App& command, CLI::Option& source, ConfocalOptics& optics);

/// Throws Error kBadInput for optics that there are not.
[[nodiscard]] int run_suggest_confocal(const ConfocalOptics& optics, const Terminal& terminal);

}  // namespace fvd::ctl
