#!/usr/bin/env bash
# The unit as systemd reads it: no mistake in it, and an exposure of at most 2.0.
# usage: unit_file_test.sh UNIT.in FVD FVDCTL
set -uo pipefail
command -v systemd-analyze >/dev/null || { echo "systemd-analyze is not installed: skipped"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sed "s|@CMAKE_INSTALL_FULL_SBINDIR@/fvd|$2|; s|@CMAKE_INSTALL_FULL_BINDIR@/fvdctl|$3|" "$1" >"$folder/fvd.service"
failed=0
# Only its own mistakes count: a container lacks units that it wants.
systemd-analyze verify --man=no --recursive-errors=no "$folder/fvd.service" || { echo "FAILED: verify"; failed=1; }
exposure=$(systemd-analyze security --offline=yes --no-pager --threshold=20 "$folder/fvd.service") ||
  { echo "FAILED: exposure above 2.0"; failed=1; }
tail -n 1 <<<"$exposure"
# What the service is for: it must not be hardened away.
for line in User=fvd StateDirectory=fvd UMask=0027 LimitRTPRIO=50 'RestartPreventExitStatus=64 78' StartLimitIntervalSec=0; do
  grep -qx "$line" "$folder/fvd.service" || { echo "FAILED: no line $line"; failed=1; }
done
grep -q '^ExecStartPre' "$folder/fvd.service" && { echo "FAILED: a failed ExecStartPre is tried again for ever"; failed=1; }
exit "$failed"
