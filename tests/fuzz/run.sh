#!/usr/bin/env bash
# Builds the fuzzers and runs each for some seconds, one after the other. Fails with a finding. The last line is one JSON
# object: how many fuzzers ran, how many of them found something.
# usage: tests/fuzz/run.sh [SECONDS [FUZZER ...]]   (default 20, all of them)
# FVD_FUZZ_BUILD_DIR   build folder (default: build-fuzz); what was found and the grown corpora are there too
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../support/setup.sh"

seconds=${1:-20}
[ $# -eq 0 ] || shift
case $seconds in '' | *[!0-9]*) fvd_say "usage: tests/fuzz/run.sh [SECONDS [FUZZER ...]]"; exit 64 ;; esac
here=$FVD_ROOT/tests/fuzz
[ $# -gt 0 ] || set -- $(cd "$here" && ls fuzz_*.cpp | sed 's/^fuzz_//; s/\.cpp$//')
fvd_packages+=(ccache clang-14 libclang-rt-14-dev)
fvd_install_packages
FVD_BUILD=${FVD_FUZZ_BUILD_DIR:-$FVD_ROOT/build-fuzz}
mkdir -p "$FVD_BUILD"
fvd_say "building in $FVD_BUILD (the first time takes some minutes)"
configure() {
  cmake -S "$FVD_ROOT" -B "$FVD_BUILD" -G Ninja -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DFVD_FUZZ=ON -DFVD_UNITY=ON -DFVD_UNITY_LIBRARIES=ON -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="-O1 -g1"
}
fvd_locked configure
fvd_locked cmake --build "$FVD_BUILD" --target write_seeds "${@/#/fuzz_}"
"$FVD_BUILD/tests/fuzz/write_seeds" "$FVD_BUILD/seeds"

# run_fuzzer NAME: false with a finding.
run_fuzzer() {
  local name=$1 log=fuzz_$1.log options=() folders=("corpus/$1")
  [ ! -d "seeds/$name" ] || folders+=("seeds/$name")
  [ ! -d "$here/corpus/$name" ] || folders+=("$here/corpus/$name")
  [ ! -f "seeds/$name.dict" ] || options+=(-dict="seeds/$name.dict")
  # A compressed picture of the largest size that a slice may have is small. Elsewhere what is read is not much more than
  # what is written; of surfaces 4 GiB of address space are mapped, of which only what is touched counts.
  case $name in
    image | stack) options+=(-rss_limit_mb=4096 -malloc_limit_mb=2048) ;;
    *) options+=(-rss_limit_mb=1024 -malloc_limit_mb=128) ;;
  esac
  mkdir -p "corpus/$name"
  # The longest input may take a minute: on a busy machine a second of work takes long.
  if ! "tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=60 -max_len=65536 "${options[@]}" \
      -artifact_prefix="finding_${name}_" "${folders[@]}" >"$log" 2>&1; then
    grep -E 'ERROR|SUMMARY|runtime error|Test unit written' "$log" | head -n 20 >&2 || true
    fvd_say "fuzz_$name: a finding; the whole log is in $FVD_BUILD/$log"
    return 1
  fi
  grep -E '^Done' "$log" | tail -n 1 | sed "s/^/$name: /"
}

findings=0
cd "$FVD_BUILD"
for name in "$@"; do run_fuzzer "$name" || findings=$((findings + 1)); done
echo "{\"fuzz_targets\": $#, \"fuzz_seconds_each\": $seconds, \"fuzz_findings_open\": $findings}"
[ "$findings" = 0 ]
