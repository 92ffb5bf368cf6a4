#!/usr/bin/env bash
# aravis_tools_test.sh FVD_SIM: Aravis' own tools find, configure and stream from the simulated camera. Skips with 77.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/aravis_tools.sh"

# A busy machine may be late for the tools' own time limits: every check has to succeed once in a few runs.
export FVD_ARV_CAMERA_OPTIONS='--frame-retention 5000'
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
open=
for run in 1 2 3 4 5; do
  rm -f "$folder"/*
  fvd_aravis_tools "$1" 2 "$folder" || exit $?
  echo "run $run"
  cat "$folder/arv-test.txt" "$folder/arv-camera-test.txt"
  {
    fvd_arv_test_failures "$folder" | sed 's/  .*//'
    [ "$(fvd_arv_camera_test "$folder" n_completed_buffers)" -gt 0 ] || echo 'arv-camera-test got no frame'
    for count in n_failures n_size_mismatch_errors n_error_packets; do
      [ "$(fvd_arv_camera_test "$folder" "$count")" -eq 0 ] || echo "arv-camera-test: $count is not 0"
    done
  } | sort >"$folder.failed"
  if [ "$run" -eq 1 ]; then open=$(cat "$folder.failed"); else open=$(comm -12 <(printf '%s\n' "$open") "$folder.failed"); fi
  rm -f "$folder.failed"
  [ -n "$open" ] || exit 0
done
printf 'never succeeded:\n%s\n' "$open"
exit 1
