#!/usr/bin/env bash
# How fvd behaves beside cameras, drives and networks as they are. Every script in `devices` is a part of its own, whose
# last line is one JSON object; the last line here is all of them in one. With names of parts ("stage") only those run.
# Fails if a part fails, if two parts have the same key, or if a promise is broken.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

# Of each part, what the documents promise.
promises() {
  case "$1" in
    camera)
      echo 'longest_wait_after_abort_ms<=500 sigterm_exit_ms<=1000 abort_rows_without_effect==0 sigterm_exits_failed==0' \
        'gvcp_busy5_jobs_ok_of_20==20 pending_ack_ok_of_20==20' \
        'silence600_jobs_ok_of_20==20 idle_camera_loss_ms<=2000 no_frames_recovered_of_10==10 camera_found_by==5' \
        'wrong_camera_used==0 wrong_slices_accepted==0 fault_cases_camera>=44'
      ;;
    setup) echo 'setup_unattended_moves==0 setup_right_of_8==8' ;;
    simulator) echo 'arv_test_failures==0 arv_camera_test_failed_buffers==0' ;;
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
python3 "$FVD_ROOT/tests/bench/merged.py" "$work"/*.txt
exit $status
