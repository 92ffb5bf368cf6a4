#!/usr/bin/env bash
# aravis_tools_test.sh FVD_SIM: Aravis' own tools find, configure and stream from the simulated camera. Skips with 77.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/aravis_tools.sh"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fvd_aravis_tools "$1" 2 "$folder" || exit $?
cat "$folder/arv-test.txt" "$folder/arv-camera-test.txt"
# How many frames come a second is for benchmarks: a busy machine may be late.
failures=$(fvd_arv_test_failures "$folder" | grep -v '^[^ ]*:FrameRate ' || true)
[ -z "$failures" ] || { printf 'arv-test fails:\n%s\n' "$failures"; exit 1; }
[ "$(fvd_arv_camera_test "$folder" n_completed_buffers)" -gt 0 ] || { echo 'arv-camera-test got no frame'; exit 1; }
for count in n_failures n_size_mismatch_errors n_error_packets; do
  [ "$(fvd_arv_camera_test "$folder" "$count")" -eq 0 ] || { echo "arv-camera-test: $count is not 0"; exit 1; }
done
