#!/bin/sh
# Power cuts at every call that brings a result to the disk, and a fault of every such call. Usage: crash.sh [BUILD] [SCHEDULES]
# Last line: one JSON object {crash_schedules, crash_violations, write_faults, write_fault_violations}.
set -eu
build=${1:-build}
schedules=${2:-10000}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
FVD_CRASH_SCHEDULES=$schedules "$build"/tests/daemon/jobs/crash_test >"$log" 2>&1 || failed=1
[ "$failed" = 0 ] || grep -A3 Failure "$log" | head -40 >&2
sed -n 's/^{"write_faults": \([0-9]*\)}$/\1/p' "$log" | awk -v crash="$(grep '^{"crash_schedules"' "$log" | tail -1)" -v failed="$failed" '
  { faults += $1 }
  END {
    if (crash == "") { print "no schedule was run" > "/dev/stderr"; exit 1 }
    sub(/}$/, "", crash)
    printf "%s, \"write_faults\": %d, \"write_fault_violations\": %d}\n", crash, faults, failed
  }'
[ "$failed" = 0 ]
