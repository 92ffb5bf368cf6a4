#!/usr/bin/env bash
# Accuracy of heights over peak methods and neighbour distances; the last line is one JSON object of the default's
# figures. An argument names the folder of reference stacks (default: ../shared/data beside the project).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_install_packages
fvd_build bench_accuracy
exec "$FVD_BUILD/tests/bench/bench_accuracy" "$@"
