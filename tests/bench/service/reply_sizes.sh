#!/bin/sh
# The longest replies that a PLC can get when every field is at its limit. Usage: reply_sizes.sh [BUILD]
# Last line: one JSON object {worst_reply_bytes_compact, worst_reply_bytes_full, replies}.
set -eu
build=${1:-build}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0
"$build"/tests/daemon/api/api_test --gtest_filter='ReplySizes.*' >"$log" 2>&1 || failed=1
[ "$failed" = 0 ] || grep -A3 Failure "$log" | head -40 >&2
grep '^{"worst_reply_bytes_compact"' "$log" | tail -1
[ "$failed" = 0 ]
