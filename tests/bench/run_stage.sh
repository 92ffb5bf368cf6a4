#!/usr/bin/env bash
# The stage driver on simulated drives: faults, steps, stops, and the accuracy report on planted errors. The last line is
# one JSON object. Takes about ten minutes; the time goes into motion, not into computing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build bench_stage
exec "$FVD_BUILD/tests/bench/bench_stage"
