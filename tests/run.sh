#!/usr/bin/env bash
# Installs what is needed, builds, runs every test. Arguments go to ctest, e.g. tests/run.sh -L unit
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/support/setup.sh"

fvd_packages+=(ccache mbpoll openssl python3-pymodbus python3-serial python3-serial-asyncio aravis-tools)  # speed; peers that are not fvd's
command -v npm >/dev/null || fvd_packages+=(nodejs npm)  # one of another source is as good
fvd_install_packages
fvd_install_javascript
fvd_unpack_nginx
fvd_build
fvd_build bench_accuracy bench_camera bench_focus bench_renderer bench_stage bench_structure bench_verdict  # not run here; they must not fall behind
# What leaks of libraries last for the life of the process; printing them would change what programs say.
export LSAN_OPTIONS="suppressions=$FVD_ROOT/tests/lsan.supp print_suppressions=0 ${LSAN_OPTIONS:-}"
# Only the thread sanitizer reads this: which libraries' locks it cannot see, and that a test's forked child starts threads.
export TSAN_OPTIONS="suppressions=$FVD_ROOT/tests/tsan.supp die_after_fork=0 ${TSAN_OPTIONS:-}"
ctest --test-dir "$FVD_BUILD" --output-on-failure --no-tests=error -j2 "$@"
