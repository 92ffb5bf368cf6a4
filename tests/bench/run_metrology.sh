#!/usr/bin/env bash
# What is measured on surfaces with analytic truth, and what its uncertainty is worth: artefacts through fvd-sim render
# and fvdctl process, files for other programs, times; the last line is one JSON object. Figures at core level come from
# the unit tests, which record them.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
source "$here/../support/setup.sh"

fvd_packages+=(admesh f3d gwyddion libgwyddion20-dev poppler-utils python3-numpy xauth xvfb)
fvd_install_packages
fvd_build bench_verdict fvdctl fvd-sim metrology_{areal,edge,filter,reference,step,study,uncertainty}_test surface_files_test system_test x3p_order_test
work=$(mktemp -d /tmp/fvd-metrology.XXXXXX)
trap 'rm -rf "$work"' EXIT
# Gwyddion's pkg-config file asks for GTK's headers, which its data fields do not need.
gcc -O1 -std=c11 -I/usr/include/gwyddion "$here/gwyddion_params.c" -o "$work/gwyddion_params" \
  $(pkg-config --cflags --libs gobject-2.0) -lgwyprocess2 -lgwyddion2 -lm
/usr/bin/python3 "$here/metrology_figures.py" "$work" "$FVD_BUILD" "$FVD_ROOT"
