#!/usr/bin/env bash
# The camera driver on simulated cameras; the last line is one JSON object. Takes about three minutes; with the argument
# "soak" a free run of ten minutes at 2048 x 2048 over a gigabit line instead.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build bench_camera
exec "$FVD_BUILD/tests/bench/bench_camera" "$@"
