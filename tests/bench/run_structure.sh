#!/usr/bin/env bash
# What must never happen, counted from the daemon's log and the plant's true velocity; the last line is one JSON object.
# tests/bench/run_structure.sh [FVD] looks at another build of fvd, e.g. of an earlier version. Its fvdctl lies in ctl/
# beside it. Takes about ten minutes.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build fvd fvdctl bench_structure
exec "$FVD_BUILD/tests/bench/bench_structure" "${1:-$FVD_BUILD/daemon/fvd}"
