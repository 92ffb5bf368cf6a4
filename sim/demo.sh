#!/usr/bin/env bash
# A simulated microscope measures a surface through the real protocol stacks: GigE Vision, Modbus TCP, JSON-RPC.
#
#   sim/demo.sh [--json] [--recipe chapter] [--world chapter] [--plant chapter] [--packet-loss 0.01] [--seed 1]
#   sim/demo.sh --page [--world groove_50] [--plant chapter] [--packet-loss 0.01] [--seed 1]
#
# --json     the last line printed is one JSON object with the figures
# --page     no measurement: the operator page, whose addresses are printed, until Ctrl-C; installs Node.js where there is none
# --world    a file of sim/worlds without .json, or a path; likewise --plant of sim/plants
set -euo pipefail
export FVD_WEB=${FVD_WEB:-AUTO}  # without npm, or without a network for it, there is a demo without the page
source "$(dirname "${BASH_SOURCE[0]}")/../tests/support/setup.sh"

usage() { sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
named_file() { if [ -f "$1" ]; then printf '%s' "$1"; else printf '%s' "$FVD_ROOT/sim/$2/$1.json"; fi; }

page="" json=() recipe=chapter world="" plant=chapter packet_loss=0 seed=1
while [ $# -gt 0 ]; do
  case $1 in
    --json) json=(--json) ;;
    --page) page=yes ;;
    --recipe|--world|--plant|--packet-loss|--seed)
      [ $# -ge 2 ] || { echo "$1 needs a value" >&2; exit 64; }
      case $1 in
        --recipe) recipe=$2 ;; --world) world=$2 ;; --plant) plant=$2 ;; --packet-loss) packet_loss=$2 ;; --seed) seed=$2 ;;
      esac
      shift ;;
    -h|--help) usage; exit 0 ;;
    *) echo "unknown option $1" >&2; usage >&2; exit 64 ;;
  esac
  shift
done
# The page's surface is one that a shipped recipe gives a verdict about.
[ -n "$world" ] || world=${page:+groove_50}
world_file=$(named_file "${world:=chapter}" worlds) plant_file=$(named_file "$plant" plants)
for file in "$world_file" "$plant_file" "$FVD_ROOT/config/recipes/$recipe.json"; do
  [ -f "$file" ] || { echo "there is no file $file" >&2; exit 64; }
done

if [ -n "$page" ]; then
  export FVD_WEB=ON
  { command -v npm && { command -v node || command -v nodejs; }; } >/dev/null || fvd_packages+=(nodejs npm)
fi
fvd_install_packages
fvd_build fvd fvdctl fvd-sim
[ -z "$page" ] || exec "$FVD_ROOT/sim/page.sh" "$FVD_BUILD" "$world_file" "$plant_file" "$seed" "$packet_loss"

source "$FVD_ROOT/sim/station.sh"
station_begin "$FVD_BUILD"
echo "== starting the simulated microscope and fvd"
start_microscope "$world_file" "$plant_file" "$seed" "$packet_loss"
start_daemon
echo "   camera $camera:3956 (GigE Vision), stage 127.0.0.1:$stage_port (Modbus TCP), fvd 127.0.0.1:$rpc_port (JSON-RPC)"
await_ready
fvdctl=("$FVD_BUILD/daemon/ctl/fvdctl" --runtime-dir "$work/run")

echo "== one trigger, as a PLC sends it"
request='{"jsonrpc":"2.0","id":1,"method":"job.start","params":{"seq":1,"part_id":"demo-part","recipe":"'$recipe'"}}'
echo "   -> $request"
exec 3<>"/dev/tcp/127.0.0.1/$rpc_port"
printf '%s\n' "$request" >&3
IFS= read -rt 10 reply <&3 || { echo "fvd did not answer; its log is $work/fvd.log" >&2; exit 70; }
exec 3>&-
echo "   <- $reply"
case $reply in *'"error"'*) exit 1 ;; esac

echo "== the scan"
"${fvdctl[@]}" watch || { tail -n 15 "$work/fvd.log" >&2; exit 1; }

echo "== the result"
result=$(find "$work/state/results" -mindepth 1 -maxdepth 1 -type d ! -name '.*' | head -n 1)
"${fvdctl[@]}" result
stop_programs
echo "   files in $result:"
find "$result" -maxdepth 1 -type f -printf '     %f\n' | sort
echo
"$FVD_BUILD/sim/fvd-sim" evaluate --world "$world_file" --seed "$seed" "$result" "${json[@]}"
