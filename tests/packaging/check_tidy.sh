#!/usr/bin/env bash
# clang-tidy (the root's .clang-tidy) on C++ sources: those that differ from a commit, or the files named.
#   check_tidy.sh SOURCE --since COMMIT [MOST]     MOST: so many files at most, the largest changes first (default 40)
#   check_tidy.sh SOURCE FILE...
set -euo pipefail
cd "$1"
shift
command -v clang-tidy >/dev/null || { echo "clang-tidy is not installed"; exit 77; }
files=()
if [ "${1:-}" = --since ]; then
  most=${3:-40}
  mapfile -t files < <(git diff --numstat --no-renames --diff-filter=AM "$2" -- 'src/*.cpp' 'elements/*.cpp' 'meshes/*.cpp' |
                       sort -rn | cut -f3)
  if [ ${#files[@]} -gt "$most" ]; then
    echo "${#files[@]} files differ from $2: the $most that changed most are looked at"
    files=("${files[@]:0:$most}")
  fi
else
  files=("$@")
fi
# the Python module is looked at where its headers are
module=OFF
[ -e /usr/include/pybind11/pybind11.h ] && module=ON
[ $module = ON ] || mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -v '^src/python/\|^$' || true)
[ ${#files[@]} -gt 0 ] || { echo "no source differs"; exit 0; }
# commands without precompiled headers, which are GCC's
cmake --preset release -B build/tidy -DWHIRL_PRECOMPILE=OFF -DWHIRL_BUILD_TESTS=OFF -DWHIRL_PYTHON=$module >/dev/null
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p build/tidy --quiet
