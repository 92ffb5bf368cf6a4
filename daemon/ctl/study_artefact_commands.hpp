#pragma once

/// The commands of studies of one artefact, and of two or more scans of one surface. Only sources of this folder
/// include it.

#include "daemon/ctl/study_options.hpp"

namespace fvd::ctl {

/// `fvdctl verify resolution|sphere|hysteresis|texture`.
void add_verifying_artefacts(CLI::App& verify, const Desk& desk);
/// `fvdctl calibrate lateral|texture`.
void add_calibrating_artefacts(CLI::App& calibrate, const Desk& desk);

}  // namespace fvd::ctl
