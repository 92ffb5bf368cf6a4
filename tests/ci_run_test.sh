#!/usr/bin/env bash
# .ci/run without arguments, with parts that do nothing: whoever ends it ends the part that has the rest of an hour, too.
# usage: ci_run_test.sh SOURCE
set -euo pipefail
folder=$(mktemp -d)
part=""
end() {
  [ -z "$part" ] || kill -KILL "$part" 2>/dev/null || true
  rm -rf "$folder"
}
trap end EXIT
fail() {
  echo "FAILED: $1"
  cat "$folder/said"
  exit 1
}
mkdir "$folder/.ci" "$folder/tests"
cp "$1/.ci/run" "$folder/.ci/run"
mkfifo "$folder/begun"
cat >"$folder/tests/run.sh" <<'STUB'
#!/usr/bin/env bash
echo "base runs"
STUB
cat >"$folder/tests/checks.sh" <<'STUB'
#!/usr/bin/env bash
[ "$1" = sanitized ] || exit 0
exec 3>begun  # open as long as it runs
echo "$$ $(sed -n 's/^SigIgn:\s*//p' "/proc/$$/status")" >&3
exec sleep 600
STUB
chmod +x "$folder/tests/run.sh" "$folder/tests/checks.sh"

"$folder/.ci/run" >"$folder/said" 2>&1 &
ci=$!
exec 4<"$folder/begun"
read -r part ignored <&4
[ $((16#$ignored & 2)) = 0 ] || fail "what runs in the hour ignores SIGINT"
kill -TERM "$ci"
status=0
wait "$ci" || status=$?
[ "$status" = 130 ] || fail "it ends with status $status"
timeout 20 cat <&4 || fail "its part goes on without it"
part=""
grep -q "base: passed" "$folder/said" || fail "the parts before are not told"
