#!/usr/bin/env bash
# CPU seconds (user and system) of a build of the program from nothing, as JSON. No compiler cache.
#   clean_build.sh SOURCE [cmake options]
set -euo pipefail
source=$(cd "$1" && pwd)
shift
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
export CCACHE_DISABLE=1
cmake --preset release -S "$source" -B "$build" -DWHIRL_BUILD_TESTS=OFF "$@" >"$build/configure.log" ||
  { cat "$build/configure.log"; exit 1; }
TIMEFORMAT='%R %U %S'
times=$( { time cmake --build "$build" >"$build/build.log" 2>&1; } 2>&1 ) || { tail -50 "$build/build.log"; exit 1; }
read -r wall user system <<<"$times"
awk -v w="$wall" -v u="$user" -v s="$system" -v n="$(nproc)" \
  'BEGIN { printf "{\"cpu_s\": %.1f, \"user_s\": %.1f, \"system_s\": %.1f, \"wall_s\": %.1f, \"processors\": %d}\n", u + s, u, s, w, n }'
