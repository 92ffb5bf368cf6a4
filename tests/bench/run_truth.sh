#!/usr/bin/env bash
# Whether a height that is printed can be trusted: scenes with truth through fvdctl process; the last line is one JSON
# object. tests/bench/run_truth.sh [FVDCTL [DATA]] looks at another build, e.g. of an earlier version; DATA is the folder
# of reference stacks (default: ../shared/data beside the project), whose figures are null where it is missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_packages+=(python3-numpy python3-opencv)
fvd_install_packages
fvd_build bench_truth fvdctl
work=$(mktemp -d /tmp/fvd-truth.XXXXXX)
trap 'rm -rf "$work"' EXIT

"$FVD_BUILD/tests/bench/bench_truth" "$work"
/usr/bin/python3 "$FVD_ROOT/tests/bench/truth_figures.py" "$work" "${1:-$FVD_BUILD/daemon/ctl/fvdctl}" \
  "${2:-$FVD_ROOT/../shared/data}"
