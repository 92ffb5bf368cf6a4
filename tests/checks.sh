#!/usr/bin/env bash
# What a compiler that is not g++, a formatter, an analyser and the sanitizers say. Last line: one JSON object of counts.
# usage: tests/checks.sh [--all] [PART ...]
#   parts   format clang tidy layers sizes threads writes headers sanitized (default: all of them)
#   --all   clang-tidy over everything, not over what changed since the version was set
# A count of a part that was not asked for is null. Known findings, which may not grow: tests/checks_known.txt.
# FVD_CHECKS_JOBS: how many compilers at once (default 2).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/support/setup.sh"

options=() parts=() sanitized=
for word in "$@"; do
  case $word in
    --all) options+=(--all) ;;
    sanitized) sanitized=1 ;;
    format | clang | tidy | layers | sizes | threads | writes | headers) parts+=("$word") ;;
    *) fvd_say "checks.sh: no part $word; parts: format clang tidy layers sizes threads writes headers sanitized"; exit 64 ;;
  esac
done
if [ ${#parts[@]} -eq 0 ] && [ -z "$sanitized" ]; then
  parts=(format layers sizes threads writes headers clang tidy)
  sanitized=1
fi

fvd_packages+=(ccache clang-14 libclang-rt-14-dev llvm-14 clang-tidy-14 clang-format-14 git python3)
fvd_install_packages
fvd_configure  # the list of commands and the generated headers

# run_sanitized FILE: builds with address,undefined in a folder of its own, runs unit and sim tests, writes the counts.
run_sanitized() {
  local build=${FVD_SANITIZED_BUILD_DIR:-$FVD_ROOT/build-sanitized} begun=$SECONDS log
  # By clang, which is faster than g++ here and whose warnings are errors in it; line numbers only, and no optimisation of
  # what runs once: half the time.
  (FVD_BUILD=$build FVD_CXX=clang++-14 FVD_SANITIZE=address,undefined FVD_UNITY=ON FVD_UNITY_LIBRARIES=ON FVD_FLAGS="-O1 -g1" FVD_SERVICE_FLAGS=-O0 FVD_TEST_FLAGS=-O0 fvd_build unit_and_sim_tests)
  fvd_say "sanitized: built in $((SECONDS - begun)) s"
  begun=$SECONDS
  log=$build/sanitized.log
  export LSAN_OPTIONS="suppressions=$FVD_ROOT/tests/lsan.supp print_suppressions=0 ${LSAN_OPTIONS:-}"
  # A failing test is counted, not the end of the script.
  ctest --test-dir "$build" -L 'unit|sim' --output-on-failure --no-tests=error -j2 >"$log" 2>&1 || true
  grep -E 'tests passed|tests failed|\(Failed\)|\(Timeout\)|\(SEGFAULT\)|Subprocess aborted|ERROR: |runtime error' "$log" | head -n 100 || true
  fvd_say "sanitized: ran in $((SECONDS - begun)) s; the whole log is in $log"
  python3 - "$log" >"$1" <<'PY'
import json, re, sys
total = re.search(r"(\d+)% tests passed, (\d+) tests? failed out of (\d+)", open(sys.argv[1], errors="replace").read())
if not total:
    sys.exit("sanitized: ctest printed no totals")
print(json.dumps({"sanitized_tests": int(total[3]), "sanitized_failed": int(total[2])}))
PY
}

if [ -n "$sanitized" ]; then
  counts=$(mktemp)
  trap 'rm -f "$counts"' EXIT
  run_sanitized "$counts"
  options+=(--sanitized "$counts")
fi
python3 "$FVD_ROOT/tests/checks.py" --build "$FVD_BUILD" --jobs "${FVD_CHECKS_JOBS:-2}" "${options[@]}" "${parts[@]}"
