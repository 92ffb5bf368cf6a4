# shellcheck shell=bash
# Sourced by sim/demo.sh and sim/page.sh: a simulated microscope and fvd beside it, on free ports.
#
# station_begin BUILD            makes the folder $work in BUILD/demo; what is started from now on ends with the script
# start_microscope WORLD_FILE PLANT_FILE SEED PACKET_LOSS    fvd-sim; sets camera (an address) and stage_port
# start_daemon [--set KEY=VALUE ...]    fvd, by config/fvd-sim.json; sets rpc_port
# await_ready                    until it can take a job
# stop_programs                  ends what was started here, and nothing else
#
# Logs, results and database are in $work and stay. A script that exits with an error has said why.

station_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
station_pids=()

stop_programs() {
  local pid
  # The newest first: fvd says goodbye to camera and stage while they are there.
  for pid in "${station_pids[@]}"; do
    kill -TERM "$pid" 2>/dev/null || true
    wait "$pid" 2>/dev/null || true
  done
  station_pids=()
}

station_begin() {
  mkdir -p "$1/demo"
  build=$(cd "$1" && pwd)  # fvd takes a path that is not whole for one beside its configuration
  work=$(mktemp -d "$build/demo/run-XXXXXX")
  trap 'trap "" INT TERM HUP; stop_programs' EXIT  # a second Ctrl-C does not cut the end short
  trap 'exit 130' INT TERM HUP
}

# start LOG PROGRAM ...: in a session of its own, so that Ctrl-C reaches this script alone, which ends them in order.
start() {
  local log=$1
  shift
  setsid "$@" >"$log" 2>&1 </dev/null &
  station_pids=("$!" "${station_pids[@]}")
}

# wait_for WHAT LOG COMMAND ...: until the command succeeds, while the newest program lives
wait_for() {
  local what=$1 log=$2 deadline=$((SECONDS + 30))
  shift 2
  until "$@"; do
    if ! kill -0 "${station_pids[0]}" 2>/dev/null || [ "$SECONDS" -ge "$deadline" ]; then
      echo "$what; the log $log ends with:" >&2
      tail -n 15 "$log" >&2
      exit 70
    fi
    sleep 0.05
  done
}

# json_value FILE KEY: a number or string of a flat JSON object
json_value() { sed -nE "s/.*\"$2\": *\"?([^\",}]+)\"?.*/\1/p" "$1" | head -n 1; }

start_microscope() {
  start "$work/fvd-sim.log" "$build/sim/fvd-sim" run --world "$1" --plant "$2" --seed "$3" --packet-loss "$4" \
    --camera-address auto --stage-port 0 --ready-file "$work/sim.json"
  wait_for "fvd-sim did not start" "$work/fvd-sim.log" test -s "$work/sim.json"
  camera=$(json_value "$work/sim.json" camera_address) stage_port=$(json_value "$work/sim.json" stage_port)
}

start_daemon() {
  start "$work/fvd.log" "$build/daemon/fvd" --config "$station_root/config/fvd-sim.json" --set camera.address="$camera" \
    --set stage.port="$stage_port" --set rpc.port=0 --set paths.state_dir="$work/state" --set paths.runtime_dir="$work/run" "$@"
  wait_for "fvd did not start" "$work/fvd.log" test -s "$work/run/rpc.json"
  rpc_port=$(json_value "$work/run/rpc.json" port)
}

station_ready() { "$build/daemon/ctl/fvdctl" --runtime-dir "$work/run" rpc system.state | grep -q '"ready": *true'; }
await_ready() { wait_for "fvd did not become ready" "$work/fvd.log" station_ready; }
