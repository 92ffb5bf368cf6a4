#!/usr/bin/env bash
# The setup of a station, on eight simulated ones: axis and camera built every way. Prints one JSON object in the last line:
# motions without an answer that asked for them, and stations whose heights are right afterwards. Takes three minutes.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../support/setup.sh"

fvd_install_packages
fvd_build setup_figures
"$FVD_BUILD/tests/bench/devices/setup_figures"
