# Sourced by tests/run.sh and sim/demo.sh: the Debian packages and the build. Sets FVD_ROOT and FVD_BUILD.
#
# FVD_BUILD_DIR   build folder (default: build)
# FVD_SANITIZE    sanitizers for every target, e.g. address,undefined or thread
# FVD_CXX         compiler in place of the system's
# FVD_FLAGS       flags of the compiler in place of those of the build type RelWithDebInfo (assertions stay on)
# FVD_TEST_FLAGS  flags of what lies below tests, after those
# FVD_SERVICE_FLAGS  flags of what lies below config and daemon, after those
# FVD_UNITY       ON: the test sources of one program compile together
# FVD_UNITY_LIBRARIES  ON: the sources of a library compile in few groups
# FVD_WEB         the operator page: ON, OFF or AUTO (default: ON where npm is found, so that a page that does not build
#                 fails the build; else AUTO)

FVD_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
FVD_BUILD=${FVD_BUILD_DIR:-$FVD_ROOT/build}

fvd_packages=(
  ca-certificates cmake fonts-dejavu-core g++ iproute2 ninja-build pkg-config
  libaravis-dev libbenchmark-dev libboost-dev libcli11-dev libeigen3-dev libfftw3-dev libgmock-dev libgtest-dev libmodbus-dev
  libopencv-dev libpango1.0-dev libpng-dev libpugixml-dev prometheus-cpp-dev libspdlog-dev libsqlite3-dev libsystemd-dev libtiff-dev libtinyxml2-dev
  libturbojpeg0-dev libusb-1.0-0-dev libvalijson-dev libzip-dev python3 zlib1g-dev
  nlohmann-json3-dev
)

fvd_say() { printf '%s\n' "$*" >&2; }

fvd_missing_packages() {
  local package
  for package in "${fvd_packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s ' "$package"
  done
}

# Installs what is missing, once and quietly; nothing to do means no network and no root are needed.
fvd_install_packages() {
  local missing runner log
  command -v dpkg-query >/dev/null || { fvd_say "this is not a Debian system: install the equivalents of: ${fvd_packages[*]}"; return 1; }
  missing=$(fvd_missing_packages)
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" -eq 0 ]; then
    runner=(env)
  elif command -v sudo >/dev/null; then
    runner=(sudo)
  else
    fvd_say "packages are missing and neither root nor sudo is at hand; ask an administrator for: apt-get install $missing"
    return 1
  fi
  fvd_say "installing Debian packages: $missing"
  log=$(mktemp)
  # shellcheck disable=SC2086  # the list is meant to be split
  if ! { "${runner[@]}" apt-get update -qq &&
         "${runner[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    fvd_say "installing failed; the whole log is in $log"
    return 1
  fi
  rm -f "$log"
}

# A Modbus stack that is not fvd's, from npm, for tests that skip without it. Versions are those of the lock file.
fvd_install_javascript() {
  local folder=$FVD_ROOT/tests/drivers/modbus/javascript log
  [ "$folder/node_modules/.package-lock.json" -nt "$folder/package-lock.json" ] && return
  log=$(mktemp)
  if ! npm ci --omit=optional --prefix "$folder" >"$log" 2>&1; then
    tail -n 5 "$log" >&2
    fvd_say "npm could not install modbus-serial; the tests that need it skip"
  fi
  rm -f "$log"
}

# nginx for the test of the reverse proxy, unpacked and not installed: the package would serve on port 80 of this machine.
fvd_unpack_nginx() {
  local folder=$FVD_BUILD/nginx
  if command -v nginx >/dev/null || [ -x /usr/sbin/nginx ] || [ -x "$folder/usr/sbin/nginx" ]; then return; fi
  mkdir -p "$folder"
  if ! (cd "$folder" && apt-get download nginx && dpkg-deb -x nginx_*.deb .) >"$folder/log" 2>&1; then
    tail -n 5 "$folder/log" >&2
    fvd_say "apt-get could not fetch nginx; the test that needs it skips"
  fi
}

# Configures in FVD_BUILD; everything is compiled through ccache where that is installed and works.
fvd_cmake() {
  local launcher=
  # One that cannot make its folder, e.g. without a home, would fail every file.
  if command -v ccache >/dev/null && echo 'int main() {}' >"$FVD_BUILD/probe.cpp" &&
     ccache c++ -c "$FVD_BUILD/probe.cpp" -o "$FVD_BUILD/probe.o" 2>/dev/null; then
    launcher=ccache
  fi
  local flags=()
  [ -z "${FVD_CXX:-}" ] || flags=(-DCMAKE_CXX_COMPILER="$FVD_CXX")
  [ -z "${FVD_FLAGS:-}" ] || flags+=(-DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS="$FVD_FLAGS")
  [ -z "${FVD_TEST_FLAGS:-}" ] || flags+=(-DFVD_TEST_FLAGS="$FVD_TEST_FLAGS")
  local web=AUTO
  if command -v npm >/dev/null; then web=ON; fi
  flags+=(-DFVD_WEB="${FVD_WEB:-$web}")
  flags+=(-DFVD_UNITY="${FVD_UNITY:-OFF}")  # off again for the checks, which look at every source
  [ -z "${FVD_SERVICE_FLAGS:-}" ] || flags+=(-DFVD_SERVICE_FLAGS="$FVD_SERVICE_FLAGS")
  flags+=(-DFVD_UNITY_LIBRARIES="${FVD_UNITY_LIBRARIES:-OFF}")
  cmake -S "$FVD_ROOT" -B "$FVD_BUILD" -G Ninja -DFVD_WERROR=ON -DFVD_SANITIZE="${FVD_SANITIZE:-}" \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" "${flags[@]}"
}

# fvd_locked COMMAND ...: runs it with its output in the build's log; copies of this script on one build folder wait for
# each other. Shows where the log speaks of errors if it fails.
fvd_locked() {
  local log="$FVD_BUILD/build.log"
  mkdir -p "$FVD_BUILD" || return 1
  exec 9>"$FVD_BUILD/.lock" && flock 9
  if ! "$@" >"$log" 2>&1 9>&-; then
    grep -E -A12 'error|Error|FAILED' "$log" | head -n 60 >&2 || true
    fvd_say "the build failed; the whole log is in $log"
    exec 9>&-
    return 1
  fi
  exec 9>&-
}

fvd_configure() { fvd_locked fvd_cmake; }

fvd_cmake_build() { fvd_cmake && cmake --build "$FVD_BUILD" "$@"; }

# fvd_build [TARGET ...]: configures and builds the targets, or everything.
fvd_build() {
  local targets=()
  [ $# -eq 0 ] || targets=(--target "$@")
  fvd_say "building in $FVD_BUILD (the first time takes some minutes)"
  fvd_locked fvd_cmake_build "${targets[@]}"
}
