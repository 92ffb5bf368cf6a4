#!/usr/bin/env bash
# Builds the fuzzers of the readers of surface files and runs each for some seconds. Fails with a finding.
# usage: tests/fuzz/run.sh [SECONDS]   (default 20)
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

seconds=${1:-20}
fvd_packages+=(ccache clang-14 libclang-rt-14-dev)
fvd_install_packages
FVD_BUILD=${FVD_FUZZ_BUILD_DIR:-$FVD_ROOT/build-fuzz}
mkdir -p "$FVD_BUILD"
fvd_say "building in $FVD_BUILD (the first time takes some minutes)"
configure() {
  cmake -S "$FVD_ROOT" -B "$FVD_BUILD" -G Ninja -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DFVD_FUZZ=ON -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="-O1 -g1"
}
fvd_locked configure
fvd_locked cmake --build "$FVD_BUILD" --target fuzzers
"$FVD_BUILD/tests/fuzz/write_seeds" "$FVD_BUILD/seeds"

failed=0
cd "$FVD_BUILD"
for format in x3p x3p_main gsf sdf tiff csv http; do
  mkdir -p "corpus/$format" "seeds/$format"
  [ ! -d "$FVD_ROOT/tests/fuzz/corpus/$format" ] || cp "$FVD_ROOT/tests/fuzz/corpus/$format"/* "seeds/$format/"
  log=fuzz_$format.log
  # 4 GiB of address space are mapped for a surface before its bytes are read: only what is touched counts.
  if ! "tests/fuzz/fuzz_$format" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=128 -max_len=65536 \
      -artifact_prefix="finding_${format}_" "corpus/$format" "seeds/$format" >"$log" 2>&1; then
    failed=1
    grep -E 'ERROR|SUMMARY|runtime error|Test unit written' "$log" | head -n 20 >&2 || true
    fvd_say "fuzz_$format: a finding; the whole log is in $FVD_BUILD/$log"
  fi
  grep -E '^(Done|#[0-9]+.DONE)' "$log" | tail -n 1 | sed "s/^/$format: /" || true
done
exit "$failed"
