#!/bin/sh
# SIGKILL between the rename of a result's folder and the job's row, on the real daemon beside fvd-sim.
# Usage: kill_rename_to_row.sh [BUILD] [KILLS] [SEED]
# Last line: one JSON object {kills_rename_to_row, half_visible, orphans_left, acked_lost, verdict_changes,
# repeated_motions}; fails unless all but the first are 0. Needs fvd and fvd-sim.
set -eu
build=${1:-build}
here=$(dirname "$0")
cmake --build "$build" --target bench_kill_at_call >&2
exec python3 "$here"/kill_rename_to_row.py "$build" "${2:-60}" "${3:-1}"
