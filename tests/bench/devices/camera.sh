#!/usr/bin/env bash
# The camera side of the devices: faults, aborts, busy and silent cameras, names. The last line is one JSON object. Takes
# about eight minutes.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../support/setup.sh"

fvd_install_packages
fvd_build bench_camera fvd fvdctl fvd-sim
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$FVD_BUILD/tests/bench/bench_camera" devices | tee "$work/driver.txt"
python3 "$FVD_ROOT/tests/bench/devices/camera_live.py" "$work/live" "$FVD_BUILD" "$FVD_ROOT" "$work/driver.txt"
