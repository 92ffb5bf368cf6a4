#!/usr/bin/env bash
# The operator page of a simulated station, from programs that are built; sim/demo.sh --page builds them.
#
#   sim/page.sh BUILD WORLD_FILE PLANT_FILE [SEED [PACKET_LOSS]]
#
# Prints an address for each role, with a token made for this station alone, and runs until Ctrl-C.
set -euo pipefail
[ $# -ge 3 ] || { sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 64; }
source "$(dirname "${BASH_SOURCE[0]}")/station.sh"

echo "== starting the simulated microscope and fvd"
station_begin "$1"
trap 'exit 0' INT TERM HUP  # the way in which it ends

# new_token NAME ROLE: the token; its line goes to the file that fvd reads
new_token() {
  local both
  both=$("$build/daemon/ctl/fvdctl" token new "$1" "$2" 2>"$work/fvdctl.log") || { cat "$work/fvdctl.log" >&2; return 1; }
  sed -n 2p <<<"$both" >>"$work/tokens"
  sed -n 1p <<<"$both"
}
(umask 077 && : >"$work/tokens")
operator=$(new_token operator operate)
setter=$(new_token setter set_up)

start_microscope "$2" "$3" "${4:-1}" "${5:-0}"
start_daemon --set http.port=0 --set rpc.token_file="$work/tokens"
http_port() { sed -nE 's/.*HTTP on 127\.0\.0\.1:([0-9]+).*/\1/p' "$work/fvd.log" | grep -m 1 .; }
wait_for "fvd did not open the page's port" "$work/fvd.log" http_port >/dev/null
await_ready

page=http://127.0.0.1:$(http_port)/
cat <<ADDRESSES
== the operator page: open one of these in a browser of this machine
   operate   starts, stops, acknowledges               $page#token=$operator
   set_up    recipes, stage by hand and studies too    $page#token=$setter
   view      looks on and changes nothing              $page
   The surface is $2; log and results are in $work.
   Ctrl-C ends the station.
ADDRESSES

status=0
wait -n "${station_pids[@]}" || status=$?
echo "a program of the station ended by itself, with status $status; fvd's log ends with:" >&2
tail -n 15 "$work/fvd.log" >&2
exit 70
