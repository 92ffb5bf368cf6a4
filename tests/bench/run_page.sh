#!/usr/bin/env bash
# What people at a station rely on, measured of the operator page in Debian's Chromium, and of what it asks, against fvd and
# fvd-sim. Every phase ends with one JSON object; the last line here is all of them in one. With names of phases ("press
# stop") only those run. Fails if a phase fails, or if a promise is broken. Phases: page/README.md.
#
# FVD_PAGE_ROUNDS       repetitions in place of each browser phase's own number, for a try
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

phases=(first walk keys press stop events reconnects resync restart viewers live large_map view3d readout orientation profile
  editor history memory attacks)
here=$FVD_ROOT/tests/bench/page
# Of every phase in a browser; the last line has their sums.
never=(console_errors csp_violations third_party_requests moves_without_press)

# Of each phase, what is promised.
promises() {
  case "$1" in
    first) echo 'bundle_gz_kib<=80 requests_first_view<=8 first_view_ms<=800' ;;
    walk)
      echo 'axe_serious==0 axe_moderate==0 states_checked>=40 states_failed==0 zoom200_overflow==0 small_targets==0' \
        'untranslated==0 wrong_on_paper==0'
      ;;
    keys) echo 'keyboard_only_job==1 jog_halt_ms<=200' ;;
    press) echo 'press_over_call_ms<=60 result_to_screen_ms<=300 presses>=100' ;;
    stop) echo 'stop_to_stage_ms<=60 stops>=100' ;;
    events) echo 'event_latency_ms<=100 events_timed>=200' ;;
    reconnects) echo 'reconnects_of_50==50 events_missed==0 events_disordered==0' ;;
    resync) echo 'state_differs_after_resync==0 resyncs_missing==0 states_compared>=10' ;;
    restart)
      echo 'results_missing_after_restart==0 page_differs_after_restart==0 restart_banner_ms<=3000 reloads==0 restarts>=10'
      ;;
    viewers)
      echo 'late_slices_with_8_viewers==0 map_latency_ratio_with_8_viewers<=1.1 rss_per_viewer_mib<=4' \
        'jobs_beside_viewers>=20'
      ;;
    live) echo 'preview_fps>=8 preview_width_px<=1280 preview_core_percent<=10' ;;
    large_map) echo 'height_20mpx_first_ms<=600 pan_zoom_fps>=30 first_pictures>=5' ;;
    view3d) echo 'view3d_fps>=20 view3d_fine_ms<=300' ;;
    readout) echo 'readout_worst_um==0 readout_misplaced==0 readout_points>=200 readout_holes>=1' ;;
    orientation) echo 'orientation_ok==1' ;;
    profile) echo 'profile_equals_cli<=0.000000001 profile_points_worst_um<=0.000000001 profile_lines>=20' ;;
    editor) echo 'editor_checks>=200 editor_differs==0 editor_accepted>=10 editor_refused>=100' ;;
    history)
      echo 'history_100k_ms<=150 history_100k_filter_ms<=300 history_100k_page_ms<=150 history_jobs>=100000'
      ;;
    memory) echo 'tab_memory_growth_mib<=20 tab_jobs>=500' ;;
    attacks) echo 'attacks_of_40==40 attacks_refused==40' ;;
  esac
}

needs_browser() { [[ " first walk keys press stop restart large_map view3d readout orientation editor memory attacks " == *" $1 "* ]]; }

run_phase() {
  case "$1" in
    events) python3 "$here/event_latency.py" "$FVD_BUILD" ;;
    viewers) python3 "$here/beside_viewers.py" "$FVD_BUILD" ;;
    reconnects | resync | live | profile | history | attacks) python3 "$here/$1.py" "$FVD_BUILD" ;;
    *) node "$here/$1.mjs" ;;
  esac
}

# What the browser phases need beside the build: the packages of the page's lock file, a browser, and Node where there is none.
install_page() {
  local log
  command -v chromium >/dev/null || fvd_packages+=(chromium)
  command -v node >/dev/null && command -v npm >/dev/null || fvd_packages+=(nodejs npm)
  fvd_install_packages
  [ "$FVD_ROOT/daemon/web/node_modules/.package-lock.json" -nt "$FVD_ROOT/daemon/web/package-lock.json" ] && return
  log=$(mktemp)
  if ! npm ci --ignore-scripts --prefix "$FVD_ROOT/daemon/web" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    fvd_say "npm could not install the page's packages; the whole log is in $log"
    return 1
  fi
  rm -f "$log"
}

chosen=("$@")
[ ${#chosen[@]} -gt 0 ] || chosen=("${phases[@]}")
browser=
for phase in "${chosen[@]}"; do
  [[ " ${phases[*]} " == *" $phase "* ]] || { fvd_say "run_page.sh: no phase $phase; phases: ${phases[*]}"; exit 64; }
  ! needs_browser "$phase" || browser=1
done
if [ -n "$browser" ]; then install_page; else fvd_install_packages; fi
fvd_build fvd fvdctl fvd-sim
export FVD_BUILD
unset FVD_PAGE_URL  # a station that runs already may be anybody's
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
results=()
for phase in "${chosen[@]}"; do
  fvd_say "== $phase, $(uptime | sed 's/.*load/load/')"
  if ! run_phase "$phase" | tee "$work/$phase.txt" || ! [ -s "$work/$phase.txt" ]; then
    fvd_say "run_page.sh: $phase failed"
    status=1
    continue
  fi
  results+=("$work/$phase.txt")
  extra=
  ! needs_browser "$phase" || extra=$(printf '%s==0 ' "${never[@]}")
  # shellcheck disable=SC2046,SC2086  # the lists are meant to be split
  python3 "$FVD_ROOT/tests/bench/promised.py" "$work/$phase.txt" $(promises "$phase") $extra || status=1
done
python3 "$FVD_ROOT/tests/bench/merged.py" --sum "$(IFS=, && echo "${never[*]}")" "${results[@]}" || status=1
exit $status
