#!/usr/bin/env bash
# The stage driver beside other masters, busy drives and gateways; the fault matrix. The last line is one JSON object.
# Takes about ten minutes; the time goes into motion, not into computing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../support/setup.sh"

fvd_build bench_stage_devices
exec "$FVD_BUILD/tests/bench/bench_stage_devices"
