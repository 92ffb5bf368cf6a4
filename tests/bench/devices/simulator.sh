#!/usr/bin/env bash
# fvd-sim under the tools of others: all checks of arv-test, and 20 s of arv-camera-test at 25 Hz with packets of 1500
# bytes. Prints one JSON object; what others found wrong goes to standard error. Exit status 77 where the tools or network
# namespaces are missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../support/setup.sh"
source "$FVD_ROOT/tests/support/aravis_tools.sh"

fvd_packages+=(aravis-tools)
fvd_install_packages
fvd_build fvd-sim
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fvd_aravis_tools "$FVD_BUILD/sim/fvd-sim" 20 "$folder"
failures=$(fvd_arv_test_failures "$folder")
[ -z "$failures" ] || printf '%s\n' "$failures" >&2
completed=$(fvd_arv_camera_test "$folder" n_completed_buffers)
[ "${completed:-0}" -gt 0 ] || { cat "$folder/arv-camera-test.txt" >&2; exit 1; }
failed=0
for count in n_failures n_timeouts n_aborted n_missing_frames n_size_mismatch_errors; do
  failed=$((failed + $(fvd_arv_camera_test "$folder" "$count")))
done
printf '{"arv_test_failures": %d, "arv_camera_test_failed_buffers": %d, "arv_camera_test_completed_buffers": %d}\n' \
  "$(printf '%s' "$failures" | grep -c . || true)" "$failed" "$completed"
