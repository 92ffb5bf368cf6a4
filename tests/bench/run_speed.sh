#!/usr/bin/env bash
# Speed of the focus core as ratios within one run; the last line is one JSON object. The yardsticks are the same job
# with OpenCV and a stored stack, a memcpy, and a Python script with OpenCV (python_triple.py) against fvdctl process.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

fvd_packages+=(python3-numpy python3-opencv)
fvd_install_packages
fvd_build bench_focus fvdctl
python=/usr/bin/python3
work=$(mktemp -d /tmp/fvd-speed.XXXXXX)
trap 'rm -rf "$work"' EXIT

"$FVD_BUILD/tests/bench/bench_focus" --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true \
  --benchmark_min_time=0.3 --benchmark_out="$work/focus.json" --benchmark_out_format=json
exec "$python" "$(dirname "${BASH_SOURCE[0]}")/speed_figures.py" "$work" "$FVD_BUILD/daemon/ctl/fvdctl"
