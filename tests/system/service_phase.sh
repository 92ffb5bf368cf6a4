#!/usr/bin/env bash
# A phase of tests/bench/run_service.sh, so short that every build can run it: what it counts has to hold, times do not.
# usage: service_phase.sh BUILD 'KEY==VALUE ...' SCRIPT [ARGUMENT ...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1 promises=$2 script=$3
shift 3
export FVD_SERVICE_TIMEOUT_S=120 # within that of the test
said=$(mktemp)
trap 'rm -f "$said"' EXIT
python3 "$here/../bench/service/$script" "$build" "$@" | tee "$said"
# shellcheck disable=SC2086  # the list is meant to be split
python3 "$here/../bench/promised.py" "$said" $promises
