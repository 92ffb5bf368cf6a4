# shellcheck shell=bash
# Sourced: Aravis' own tools against a camera of fvd-sim, in a network namespace of their own.

# fvd_aravis_tools FVD_SIM SECONDS FOLDER: leaves sim.txt, arv-test.txt and arv-camera-test.txt in the folder. Returns 77,
# with the reason, where the tools are missing or the system allows no namespace. FVD_ARV_CAMERA_OPTIONS go to
# arv-camera-test.
fvd_aravis_tools() {
  local tool own=(unshare -n)
  [ "$(id -u)" -eq 0 ] || own=(unshare -rn)
  for tool in arv-test-0.8 arv-camera-test-0.8; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool (Debian package aravis-tools) is not there" >&2; return 77; }
  done
  "${own[@]}" ip link set lo up 2>/dev/null || { echo "skipped: this system does not allow a network namespace" >&2; return 77; }
  "${own[@]}" bash -euc '
    ip link set lo up
    "$1" run --world "$4/sim/worlds/flat.json" --discoverable --serial ARV1 --name arv --stage-port 0 \
      --ready-file "$3/ready.json" >"$3/sim.txt" 2>&1 &
    sim=$!
    trap "kill $sim; wait $sim || true" EXIT
    for _ in $(seq 600); do [ -e "$3/ready.json" ] && break; sleep 0.1; done
    [ -e "$3/ready.json" ] || { cat "$3/sim.txt" >&2; exit 1; }
    timeout 300 arv-test-0.8 --packet-socket --configuration "$4/tests/support/arv_test.cfg" >"$3/arv-test.txt" 2>&1
    # Discovery finds it by its serial number behind vendor and model.
    timeout $(($2 + 60)) arv-camera-test-0.8 --name fvd-SimulatedCamera-ARV1 --frequency 25 --gv-packet-size 1500 \
      --duration "$2" ${FVD_ARV_CAMERA_OPTIONS:-} >"$3/arv-camera-test.txt" 2>&1
  ' - "$@" "$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
}

# Checks of arv-test that did not succeed, one a line; one that says so where it tested nothing.
fvd_arv_test_failures() {
  grep -q '^Found 1 device$' "$1/arv-test.txt" && grep -q ' SUCCESS' "$1/arv-test.txt" || echo 'no device was tested'
  grep -E '^[A-Za-z0-9]+:' "$1/arv-test.txt" | grep -vE '^[^ ]+ +(SUCCESS|IGNORED)' || true
}

# fvd_arv_camera_test FOLDER NAME: one of the counts that arv-camera-test ends with.
fvd_arv_camera_test() { sed -n "s/^$2 *= *//p" "$1/arv-camera-test.txt"; }
