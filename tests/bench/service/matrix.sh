#!/bin/sh
# Who may call what, by every way in, and what a page in a real Chromium can do to either port. Usage: matrix.sh [BUILD]
# Needs what BUILD has built: access_matrix_test, fvd, fvdctl. Without `chromium` that part is skipped and told: page_attempts is 0.
# Last line: one JSON object {unauthorised_accepted, matrix_cases, page_attempts, chromium}.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
FVD_MATRIX_FILE=$work/matrix "$build"/tests/daemon/transport/access_matrix_test >"$work/log" 2>&1 || failed=1
[ "$failed" = 0 ] || grep -A5 Failure "$work/log" | head -40 >&2
"$here"/hostile_page.py "$build" >"$work/page"
/usr/bin/python3 - "$work/matrix" "$work/page" <<'END'
import json, sys
matrix, page = (json.loads(open(name, encoding="utf-8").read().splitlines()[-1]) for name in sys.argv[1:])
print(json.dumps({"unauthorised_accepted": matrix["unauthorised_accepted"] + page["unauthorised_accepted"],
                  "matrix_cases": matrix["matrix_cases"], "page_attempts": page["attempts"],
                  "chromium": page["chromium"]}))
END
[ "$failed" = 0 ]
