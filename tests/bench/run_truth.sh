#!/usr/bin/env bash
# Whether a height that is printed can be trusted: scenes with truth through fvdctl process, live scans of the simulated
# microscope, the tables of names and pages, and the speed of it all (run_speed.sh); the last line is one JSON object.
# tests/bench/run_truth.sh [FVDCTL [DATA]] looks at another build's fvdctl alone, e.g. of an earlier version; DATA is the
# folder of reference stacks (default: ../shared/data beside the project), whose figures are null where it is missing.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../support/setup.sh"

fvd_packages+=(python3-numpy python3-opencv)
fvd_install_packages
fvd_build bench_truth replay_test fvd fvdctl fvd-sim
work=$(mktemp -d /tmp/fvd-truth.XXXXXX)
trap 'rm -rf "$work"' EXIT
python=/usr/bin/python3

others=()
if [ $# -eq 0 ]; then
  "$here/run_speed.sh" | tee "$work/speed"
  mkdir "$work/live"
  "$python" "$here/truth_live.py" "$work/live" "$FVD_BUILD" "$FVD_ROOT" | tee "$work/live.json"
  "$python" "$here/truth_reading.py" "$FVD_BUILD" "$FVD_ROOT" | tee "$work/reading.json"
  others=("$work/speed" "$work/live.json" "$work/reading.json")
fi
mkdir "$work/scenes"
"$FVD_BUILD/tests/bench/bench_truth" "$work/scenes"
"$python" "$here/truth_figures.py" "$work/scenes" "${1:-$FVD_BUILD/daemon/ctl/fvdctl}" \
  "${2:-$FVD_ROOT/../shared/data}" "${others[@]}"
