#!/usr/bin/env bash
# How fvd behaves beside cameras, drives and networks as they are. Every script in `devices` is a part of its own, whose
# last line is one JSON object; the last line here is all of them in one. With names of parts ("stage") only those run.
# Fails if a part fails, if two parts have the same key, or if a promise is broken.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

# Of each part, the promises that are kept on any machine.
promises() {
  case "$1" in
    stage)
      echo 'torque_drops==0 moves_not_ours==0 busy5_jobs_ok_of_50==50 wrong_values_accepted==0 motions_too_many==0' \
        'wrong_unit_accepted==0 wrong_protocol_accepted==0 fault_cases_stage>=260'
      ;;
  esac
}

fvd_install_packages
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
parts=("$@")
if [ ${#parts[@]} -eq 0 ]; then
  for script in "$FVD_ROOT"/tests/bench/devices/*.sh; do parts+=("$(basename "$script" .sh)"); done
fi
status=0
for part in "${parts[@]}"; do
  fvd_say "== $part"
  bash "$FVD_ROOT/tests/bench/devices/$part.sh" | tee "$work/$part.txt"
  # shellcheck disable=SC2046  # the list is meant to be split
  python3 "$FVD_ROOT/tests/bench/promised.py" "$work/$part.txt" $(promises "$part") || status=1
done
python3 - "$work"/*.txt <<'PY'
import json
import sys

merged = {}
for name in sys.argv[1:]:
    with open(name, encoding="utf-8") as file:
        part = json.loads(file.read().rstrip("\n").rsplit("\n", 1)[-1])
    twice = merged.keys() & part.keys()
    if twice:
        sys.exit(f"run_devices.sh: {name}: another part has these keys, too: {', '.join(sorted(twice))}")
    merged.update(part)
print(json.dumps(merged))
PY
exit $status
