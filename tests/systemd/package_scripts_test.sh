#!/usr/bin/env bash
# Maintainer scripts, sysusers and tmpfiles as their own programs read them. usage: package_scripts_test.sh SOURCE/systemd
set -uo pipefail
failed=0
for script in "$1"/debian/{postinst,prerm,postrm}; do
  sh -n "$script" || { echo "FAILED: $script"; failed=1; }
  [ -x "$script" ] || { echo "FAILED: $script is not executable"; failed=1; }
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/etc" "$folder/run/lock" "$folder/sys"
: >"$folder/etc/passwd"
: >"$folder/etc/group"
if command -v systemd-sysusers >/dev/null && [ "$(id -u)" = 0 ]; then
  systemd-sysusers --root="$folder" - <"$1/fvd.sysusers" >/dev/null || { echo "FAILED: sysusers"; failed=1; }
  grep -q '^fvd:.*:/var/lib/fvd:/usr/sbin/nologin$' "$folder/etc/passwd" || { echo "FAILED: no user fvd"; failed=1; }
  for group in fvd fvd-view; do grep -q "^$group:" "$folder/etc/group" || { echo "FAILED: no group $group"; failed=1; }; done
  systemd-tmpfiles --root="$folder" --create - <"$1/fvd.tmpfiles" || { echo "FAILED: tmpfiles"; failed=1; }
  [ "$(stat -c %a "$folder/run/lock/fvd")" = 1777 ] || { echo "FAILED: no folder for locks"; failed=1; }
else
  echo "not root, or no systemd: users and folders are not tried"
fi
exit "$failed"
