#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds Whirl, and runs or tests it.
#   ./build.sh                  install + build
#   ./build.sh run DECK [...]   ... then: whirl run DECK [...]
#   ./build.sh test [...]       ... then: all tests but the long ones (or those that ctest arguments name: test -L long, -L hours)
# WHIRL_NO_VTK=1 leaves VTK out; WHIRL_NO_INSTALL=1 installs nothing. Quick when there is nothing to do.
set -euo pipefail
cd "$(dirname "$0")"

packages=(g++ cmake ninja-build libeigen3-dev libsuitesparse-dev libsundials-dev libgtest-dev libtomlplusplus-dev
          libcli11-dev libfmt-dev nlohmann-json3-dev libhdf5-dev libpng-dev libmd-dev libminizip-dev libexpat1-dev)
[ "${WHIRL_NO_VTK:-0}" = 1 ] || packages+=(libvtk9-dev)
# the long tests try the Python module
[ "${1:-}" = test ] && [[ " $* " = *" long "* ]] && packages+=(python3-dev pybind11-dev python3-numpy python3-scipy)

install_missing() {
  local missing=() p
  for p in "${packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null || true)" = installed ] || missing+=("$p")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  local root=()
  [ "$(id -u)" = 0 ] || root=(sudo)
  echo "installing: ${missing[*]}"
  "${root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

build() {
  local options=()
  [ "${WHIRL_NO_VTK:-0}" = 1 ] && options+=(-DWHIRL_WITH_VTK=OFF)
  # The tests are built only when asked for: a first run-up should not wait for them.
  [ "$1" = test ] && options+=(-DWHIRL_BUILD_TESTS=ON) || { [ -e build/release/build.ninja ] || options+=(-DWHIRL_BUILD_TESTS=OFF); }
  if [ ! -e build/release/build.ninja ] || [ ${#options[@]} -gt 0 ]; then
    cmake --preset release "${options[@]}" >build-configure.log 2>&1 || { cat build-configure.log; exit 1; }
    mkdir -p build && mv build-configure.log build/configure.log
  fi
  cmake --build --preset release
}

case "${1:-build}" in
  build) install_missing; build all ;;
  run)   shift; install_missing; build run; exec build/release/bin/whirl run "$@" ;;
  test)  shift; [ $# -gt 0 ] || set -- -LE 'long|hours'
         install_missing; build test; exec ctest --preset release -j "$(nproc)" "$@" ;;
  *)     sed -n '2,6p' "$0"; exit 2 ;;
esac
