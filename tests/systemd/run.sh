#!/usr/bin/env bash
# Builds the Debian package and lives through it in a machine of its own; see package_test.py. Passes with a message where
# no machine can be booted. Arguments go to package_test.py.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_packages+=(debootstrap dpkg-dev lintian systemd-container)
fvd_install_packages
fvd_build fvd fvdctl fvd-sim man
status=0
python3 "$FVD_ROOT/tests/systemd/package_test.py" --build "$FVD_BUILD" "$@" || status=$?
[ "$status" = 77 ] || exit "$status"
