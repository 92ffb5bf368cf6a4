#!/usr/bin/env bash
# What `systemd-analyze security` says of the unit as it is installed: {"security_exposure": 0 to 10}.
# usage: exposure.sh BUILD
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sed 's|@CMAKE_INSTALL_FULL_SBINDIR@|/usr/sbin|; s|@CMAKE_INSTALL_FULL_BINDIR@|/usr/bin|' "$root/systemd/fvd.service.in" >"$folder/fvd.service"
systemd-analyze security --offline=yes --no-pager "$folder/fvd.service" | tee "$folder/said" | tail -n 1
exposure=$(sed -n 's/.*Overall exposure level for fvd.service: \([0-9.]*\).*/\1/p' "$folder/said")
[ -n "$exposure" ] || { echo "exposure.sh: systemd-analyze tells no exposure" >&2; exit 1; }
echo "{\"security_exposure\": $exposure}"
