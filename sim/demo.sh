#!/usr/bin/env bash
# A simulated microscope measures a surface through the real protocol stacks: GigE Vision, Modbus TCP, JSON-RPC.
#
#   sim/demo.sh [--json] [--recipe chapter] [--world chapter] [--plant chapter] [--packet-loss 0.01] [--seed 1]
#
# --json     the last line printed is one JSON object with the figures
# --world    a file of sim/worlds without .json, or a path; likewise --plant of sim/plants
set -euo pipefail
export FVD_WEB=${FVD_WEB:-AUTO}  # without npm, or without a network for it, there is a demo without the page
source "$(dirname "${BASH_SOURCE[0]}")/../tests/support/setup.sh"

usage() { sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
named_file() { if [ -f "$1" ]; then printf '%s' "$1"; else printf '%s' "$FVD_ROOT/sim/$2/$1.json"; fi; }

json=() recipe=chapter world=chapter plant=chapter packet_loss=0 seed=1
while [ $# -gt 0 ]; do
  case $1 in
    --json) json=(--json) ;;
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
world_file=$(named_file "$world" worlds) plant_file=$(named_file "$plant" plants)
for file in "$world_file" "$plant_file" "$FVD_ROOT/config/recipes/$recipe.json"; do
  [ -f "$file" ] || { echo "there is no file $file" >&2; exit 64; }
done

fvd_install_packages
fvd_build fvd fvdctl fvd-sim

mkdir -p "$FVD_BUILD/demo"
work=$(mktemp -d "$FVD_BUILD/demo/run-XXXXXX")
pids=()
stop_programs() {
  local pid
  # fvd first: it says goodbye to camera and stage while they are there
  for pid in "${pids[@]}"; do
    kill -TERM "$pid" 2>/dev/null || true
    wait "$pid" 2>/dev/null || true
  done
  pids=()
}
trap stop_programs EXIT
trap 'exit 130' INT TERM

# wait_for FILE PID LOG: until the program with PID has written FILE
wait_for() {
  local deadline=$((SECONDS + 30))
  until [ -s "$1" ]; do
    if ! kill -0 "$2" 2>/dev/null || [ "$SECONDS" -ge "$deadline" ]; then
      echo "a program did not start; its log $3 ends with:" >&2
      tail -n 15 "$3" >&2
      exit 70
    fi
    sleep 0.05
  done
}
# json_value FILE KEY: a number or string of a flat JSON object
json_value() { sed -nE "s/.*\"$2\": *\"?([^\",}]+)\"?.*/\1/p" "$1" | head -n 1; }

echo "== starting the simulated microscope and fvd"
"$FVD_BUILD/sim/fvd-sim" run --world "$world_file" --plant "$plant_file" --seed "$seed" --packet-loss "$packet_loss" \
  --camera-address auto --stage-port 0 --ready-file "$work/sim.json" >"$work/fvd-sim.log" 2>&1 &
sim_pid=$!
pids=("$sim_pid")
wait_for "$work/sim.json" "$sim_pid" "$work/fvd-sim.log"
camera=$(json_value "$work/sim.json" camera_address) port=$(json_value "$work/sim.json" stage_port)
"$FVD_BUILD/daemon/fvd" --config "$FVD_ROOT/config/fvd-sim.json" --set camera.address="$camera" \
  --set stage.port="$port" --set rpc.port=0 --set paths.state_dir="$work/state" --set paths.runtime_dir="$work/run" \
  >"$work/fvd.log" 2>&1 &
fvd_pid=$!
pids=("$fvd_pid" "$sim_pid")
wait_for "$work/run/rpc.json" "$fvd_pid" "$work/fvd.log"
rpc_port=$(json_value "$work/run/rpc.json" port)
echo "   camera $camera:3956 (GigE Vision), stage 127.0.0.1:$port (Modbus TCP), fvd 127.0.0.1:$rpc_port (JSON-RPC)"
fvdctl=("$FVD_BUILD/daemon/ctl/fvdctl" --runtime-dir "$work/run")
deadline=$((SECONDS + 20))
until "${fvdctl[@]}" rpc system.state | grep -q '"ready": *true'; do
  [ "$SECONDS" -lt "$deadline" ] || { echo "fvd did not become ready; its log is $work/fvd.log" >&2; exit 69; }
  sleep 0.1
done

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
