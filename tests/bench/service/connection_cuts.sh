#!/bin/sh
# The example program of a line, its connection cut after k bytes of its loop in each direction. Usage: connection_cuts.sh [BUILD] [CUTS]
# Last line: one JSON object {cuts, cuts_share, repeated_motions, lost}. CUTS: so many, evenly over the loop's bytes (600); 0 = after every one.
set -eu
build=${1:-build}
exec python3 -B "$(dirname "$0")/../../system/connection_cuts_test.py" "$build/daemon/fvd" "$build/sim/fvd-sim" "${2:-600}"
