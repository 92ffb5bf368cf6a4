#!/usr/bin/env bash
# The stage driver on simulated drives: faults, steps, stops, and the accuracy report on planted errors. The last line is
# one JSON object. Takes about ten minutes; the time goes into motion, not into computing. Fails if a stop takes longer
# than its bound: one response timeout, plus what the drive itself takes to answer.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build bench_stage
output=$(mktemp)
trap 'rm -f "$output"' EXIT
"$FVD_BUILD/tests/bench/bench_stage" | tee "$output"
python3 "$FVD_ROOT/tests/bench/promised.py" "$output" 'wrong_values_accepted==0' 'stop_latency_over_timeout<=1'
