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
echo passed
