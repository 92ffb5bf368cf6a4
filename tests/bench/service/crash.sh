#!/bin/sh
# Power cuts at every call that brings a result to the disk, and every fault of every call that writes.
# Usage: crash.sh [BUILD] [SCHEDULES]
# Last line: one JSON object {crash_schedules, crash_violations, write_faults, write_fault_violations}; fails unless both
# violations are 0. Needs crash_test and write_faults_test; about 15 minutes on two cores.
set -eu
build=${1:-build}
schedules=${2:-10000}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
FVD_CRASH_SCHEDULES=$schedules "$build"/tests/daemon/jobs/crash_test >"$log" 2>&1 || failed=1
FVD_ALL_WRITE_FAULTS=1 "$build"/tests/daemon/jobs/write_faults_test >>"$log" 2>&1 || failed=1
[ "$failed" = 0 ] || grep -a -A3 Failure "$log" | head -40 >&2
grep -a '^{"\(crash_schedules\|write_faults\)"' "$log" | python3 -c '
import json, sys
sums = dict.fromkeys(("crash_schedules", "crash_violations", "write_faults", "write_fault_violations"), 0)
for line in sys.stdin:
    for key, value in json.loads(line).items():
        sums[key] += value
if not sums["crash_schedules"] or not sums["write_faults"]:
    sys.exit("crash.sh: nothing was run")
print(json.dumps(sums))'
[ "$failed" = 0 ]
