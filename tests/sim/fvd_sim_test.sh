#!/bin/bash
# fvd_sim_test.sh FVD_SIM: the program serves every drive on a serial line, and says which faults did not happen.
set -euo pipefail
fvd_sim=$1
work=$(mktemp -d)
pid=
trap '[ -z "$pid" ] || kill "$pid" 2>/dev/null || true; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; cat "$work/log" >&2; exit 1; }

# serve STATUS OPTION...: starts, waits until it serves, ends it, and expects STATUS
serve() {
  local expected=$1 status=0 deadline=$((SECONDS + 30))
  shift
  rm -f "$work/ready"
  "$fvd_sim" run --camera-address auto --ready-file "$work/ready" "$@" >"$work/log" 2>&1 &
  pid=$!
  until [ -s "$work/ready" ]; do
    kill -0 "$pid" 2>/dev/null || fail "it did not start with $*"
    [ "$SECONDS" -lt "$deadline" ] || fail "it is not ready with $*"
    sleep 0.02
  done
  [ -z "${link:-}" ] || [ -c "$(readlink -f "$link")" ] || fail "no serial line at $link"
  kill -TERM "$pid"
  wait "$pid" || status=$?
  pid=
  [ "$status" -eq "$expected" ] || fail "status $status instead of $expected with $*"
}

for drive in az ar leadshine scl cia402; do
  link=$work/line
  serve 0 --drive "$drive" --stage-pty "$link" --line-timing 19200,4,1
  grep -q "\"stage_pty\": \"$link\", \"drive\": \"$drive\"" "$work/ready" || fail "the ready file does not say where"
  [ ! -e "$link" ] || fail "the link is left behind"
done
link=
echo '[{"fault": "lost_reply"}, {"on": "write", "fault": "link_cut", "count": 2}]' >"$work/faults.json"
serve 1 --stage-port 0 --faults "$work/faults.json"
grep -q 'step 2: link_cut on write, 2 times to go' "$work/log" || fail "it does not say what did not happen"
echo '[]' >"$work/faults.json"
serve 0 --stage-port 0 --faults "$work/faults.json"
echo '[{"fault": "lost_repli"}]' >"$work/faults.json"
status=0
"$fvd_sim" run --stage-port 0 --faults "$work/faults.json" >"$work/log" 2>&1 || status=$?
[ "$status" -eq 78 ] || fail "status $status for a bad script"
grep -q '/0/fault' "$work/log" || fail "it does not say where the script is bad"
for wrong in "--drive no" "--line-timing 1,2,3" "--stage-pty $work/line --stage-port 0" "--stage-pty $work/line --line-timing 5"; do
  status=0
  # shellcheck disable=SC2086  # options are meant to be split
  "$fvd_sim" run $wrong >"$work/log" 2>&1 || status=$?
  [ "$status" -eq 64 ] || fail "status $status for $wrong"
done
status=0
"$fvd_sim" run --stage-pty "$work/line" --line-timing 5,0,0 >"$work/log" 2>&1 || status=$?
[ "$status" -eq 78 ] || fail "status $status for a line that cannot be"

for wrong in "--serial 0123456789ABCDEF" "--name 0123456789ABCDEF" "--drive gcs --word-order low-first"; do
  status=0
  # shellcheck disable=SC2086  # options are meant to be split
  "$fvd_sim" run --camera-address auto --stage-port 0 $wrong >"$work/log" 2>&1 || status=$?
  [ "$status" -eq 78 ] || fail "status $status for $wrong"
done
serve 0 --stage-port 0 --serial S1 --name left --discoverable --width-increment 8 --word-order low-first

# A rendered stack, and what cannot be rendered.
worlds=$(dirname "${BASH_SOURCE[0]}")/../../sim/worlds
"$fvd_sim" render "$worlds/layered_equal.json" "$work/stack" --start-um 300 --step-um 30 --slices 3 --seed 4 --format pgm >"$work/log"
grep -q '3 slices from 300 to 360 um' "$work/log" || fail "it does not say what it rendered"
[ "$(tail -n 3 "$work/stack/z.txt" | tr '\n' ' ')" = "300 330 360 " ] || fail "z.txt"
for file in slice_0000.pgm slice_0002.pgm truth/truth.gsf truth/truth.json truth/regions.png; do
  [ -s "$work/stack/$file" ] || fail "no $file"
done
# refused STATUS WORD ARGUMENT...
refused() {
  local expected=$1 word=$2 status=0
  shift 2
  "$fvd_sim" render "$@" >"$work/log" 2>&1 || status=$?
  [ "$status" -eq "$expected" ] || fail "status $status for render $*"
  grep -q -- "$word" "$work/log" || fail "render $* does not say $word"
}
refused 65 'not empty' "$worlds/layered_equal.json" "$work/stack"
refused 64 absent.json "$work/absent.json" "$work/new"
refused 64 --format "$worlds/layered_equal.json" "$work/new" --format jpg
refused 64 --slices "$worlds/layered_equal.json" "$work/new" --slices many
refused 65 step "$worlds/layered_equal.json" "$work/new" --step-um 0
refused 64 folder "$worlds/layered_equal.json"
echo '{"surface": "layered", "near_gray": 3}' >"$work/world.json"
refused 78 near_grey "$work/world.json" "$work/new"
[ ! -e "$work/new" ] || fail "a folder is left of what was refused"
echo passed
