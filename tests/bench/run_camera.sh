#!/usr/bin/env bash
# The camera driver on simulated cameras; the last line is one JSON object. Takes about three minutes; with the argument
# "soak" a free run of ten minutes at 2048 x 2048 over a gigabit line instead. Fails if the camera's loss is noticed
# later than 1.5 s after the frame it owes (camera.silence_ms is 1 s), or it works again later than a second after its return.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build bench_camera
[ $# -eq 0 ] || exec "$FVD_BUILD/tests/bench/bench_camera" "$@"
output=$(mktemp)
trap 'rm -f "$output"' EXIT
"$FVD_BUILD/tests/bench/bench_camera" | tee "$output"
python3 "$FVD_ROOT/tests/bench/promised.py" "$output" 'wrong_slices_accepted==0' 'accounting_violations==0' \
  'hang_detect_ms<=1500' 'recover_ms_after_restart<=1000'
