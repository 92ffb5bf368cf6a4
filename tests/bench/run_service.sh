#!/usr/bin/env bash
# What a line and an administrator rely on, measured of the programs fvd, fvd-sim and fvdctl: kills, load, stops, backups,
# years of jobs, the package. Every phase ends with one JSON object; the last line here is all of them in one. With names
# of phases ("kills poll") only those run. Fails if a phase fails, or if a promise is broken.
#
# FVD_SERVICE_JOBS      jobs of the phase soak (default 2000)
# FVD_SERVICE_CUTS      cuts of the phase cuts (default 0: one at every byte, 20 minutes)
# FVD_SERVICE_FUZZ_S    seconds of each fuzzer (default 20)
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

phases=(trigger stop jog ready kills poll restore soak crash matrix replies cuts exposure nspawn fuzz)
here=$FVD_ROOT/tests/bench/service

# Of each phase, what is promised.
promises() {
  case "$1" in
    trigger) echo 'trigger_p99_ms<=5 triggers>=400' ;;
    stop) echo 'stop_without_lease_ms<=60 stops>=100' ;;
    jog) echo 'jog_overrun_ms<=200 jogs>=40' ;;
    ready) echo 'ready_cold_ms<=2000 ready_after_kill_ms<=1000 ready_starts>=20' ;;
    kills)
      echo 'kills>=300 kills_random>=60 kills_acquisition>=60 kills_end>=60 kills_start>=60 kills_rename_to_row>=60' \
        'acked_lost==0 half_visible==0 repeated_motions==0 verdict_changes==0 orphans_left==0 moving_while_released==0' \
        'times_free>=60 motions>=60 acked>=1'
      ;;
    poll) echo 'poll_p99_ms<=5 late_slices==0 poll_calls>=50000 poll_jobs>=2 poll_acks>=1 poll_longest_ack_ms>=500' ;;
    restore) echo 'restore_differs==0 restore_repeated_motions==0 restore_jobs>=10' ;;
    soak) echo 'rss_slope_kib_per_job<=0.5 fd_slope_per_job<=0 state_gib_bounded==1 soak_jobs>=2000' ;;
    crash) echo 'crash_schedules>=10000 crash_violations==0 write_faults>=1 write_fault_violations==0' ;;
    matrix) echo 'unauthorised_accepted==0 matrix_cases>=1000 chromium==1 page_attempts>=100' ;;
    replies) echo 'worst_reply_bytes_compact<=440 worst_reply_bytes_full<=1400' ;;
    cuts) echo 'cuts>=1 cuts_share>=0.9 cuts_repeated_motions==0 cuts_lost==0' ;;
    exposure) echo 'security_exposure<=2.0' ;;
    nspawn) echo 'nspawn_missing==0' ;;
    fuzz) echo 'fuzz_targets>=9 fuzz_findings_open==0' ;;
  esac
}

# What lies below tests is built by the programs of the phase itself where it is not named here.
targets() {
  case "$1" in
    poll) echo poll_load bench_slow_sync ;;
    crash) echo crash_test write_faults_test ;;
    matrix) echo access_matrix_test ;;
    replies) echo api_test ;;
  esac
}

run_phase() {
  case "$1" in
    trigger | stop | jog) python3 "$here/latency.py" "$FVD_BUILD" "$1" ;;
    ready | poll | restore) python3 "$here/$1.py" "$FVD_BUILD" ;;
    kills) python3 "$here/kills.py" "$FVD_BUILD" all ;;
    soak) python3 "$here/soak.py" "$FVD_BUILD" "${FVD_SERVICE_JOBS:-2000}" ;;
    crash) bash "$here/crash.sh" "$FVD_BUILD" ;;
    matrix) bash "$here/matrix.sh" "$FVD_BUILD" ;;
    replies) bash "$here/reply_sizes.sh" "$FVD_BUILD" ;;
    cuts) # its keys beside those of the kills
      bash "$here/connection_cuts.sh" "$FVD_BUILD" "${FVD_SERVICE_CUTS:-0}" |
        sed '$s/"repeated_motions"/"cuts_repeated_motions"/; $s/"lost"/"cuts_lost"/'
      ;;
    exposure) bash "$here/exposure.sh" "$FVD_BUILD" ;;
    nspawn) bash "$FVD_ROOT/tests/systemd/run.sh" | python3 "$here/nspawn.py" ;;
    fuzz) bash "$FVD_ROOT/tests/fuzz/run.sh" "${FVD_SERVICE_FUZZ_S:-20}" ;;
  esac
}

chosen=("$@")
[ ${#chosen[@]} -gt 0 ] || chosen=("${phases[@]}")
wanted=(fvd fvdctl fvd-sim)
for phase in "${chosen[@]}"; do
  [[ " ${phases[*]} " == *" $phase "* ]] || { fvd_say "run_service.sh: no phase $phase; phases: ${phases[*]}"; exit 64; }
  # shellcheck disable=SC2207  # the list is meant to be split
  wanted+=($(targets "$phase"))
done
fvd_install_packages
fvd_build "${wanted[@]}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
results=()
for phase in "${chosen[@]}"; do
  fvd_say "== $phase, $(uptime | sed 's/.*load/load/')"
  if ! run_phase "$phase" | tee "$work/$phase.txt" || ! [ -s "$work/$phase.txt" ]; then
    fvd_say "run_service.sh: $phase failed"
    status=1
    continue
  fi
  results+=("$work/$phase.txt")
  # shellcheck disable=SC2046  # the list is meant to be split
  python3 "$FVD_ROOT/tests/bench/promised.py" "$work/$phase.txt" $(promises "$phase") || status=1
done
python3 "$FVD_ROOT/tests/bench/merged.py" "${results[@]}" || status=1
exit $status
