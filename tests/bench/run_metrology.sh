#!/usr/bin/env bash
# What is measured on surfaces with analytic truth, and what its uncertainty is worth: artefacts through fvd-sim render
# and fvdctl process, files for other programs, times; the last line is one JSON object. Figures at core level come from
# the unit tests, which record them.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../support/setup.sh"

fvd_packages+=(admesh gwyddion python3-numpy)
fvd_install_packages
fvd_build fvdctl fvd-sim metrology_areal_test metrology_edge_test metrology_filter_test metrology_step_test \
  metrology_uncertainty_test
work=$(mktemp -d /tmp/fvd-metrology.XXXXXX)
trap 'rm -rf "$work"' EXIT
/usr/bin/python3 "$here/metrology_figures.py" "$work" "$FVD_BUILD" "$FVD_ROOT"
