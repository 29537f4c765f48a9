#!/usr/bin/env bash
# Sources and headers of the product parse each by itself, without precompiled headers and without a warning: a missing #include
# fails here. Warnings that need whole builds are the builds' own (WHIRL_WERROR=ON).
#   check_warnings.sh SOURCE                   all sources
#   check_warnings.sh SOURCE --since COMMIT [MOST]   sources and headers that differ from a commit; MOST: so many at most, the largest
#                                              changes first (default: all of them)
#   check_warnings.sh SOURCE FILE...
set -euo pipefail
cd "$1"
shift
kinds=('src/*.cpp' 'elements/*.cpp' 'meshes/*.cpp')
case "${1:-}" in
  --since) most=${3:-}
           mapfile -t files < <(git diff --numstat --no-renames --diff-filter=AM "$2" -- "${kinds[@]}" 'src/*.hpp' 'elements/*.hpp' 'meshes/*.hpp' |
                                sort -rn | cut -f3) ;;
  '')      mapfile -t files < <(git ls-files "${kinds[@]}") ;;
  *)       files=("$@") ;;
esac
mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -v '/sundials/\|/vtk/\|/hdf5/\|/mpi/\|\.in$\|^$' || true)
# the Python module is looked at where its headers are
if [ -e /usr/include/pybind11/pybind11.h ]; then
  export PYTHON_FLAGS=$(/usr/bin/python3-config --includes | sed 's/-I/-isystem /g')
else
  mapfile -t files < <(printf '%s\n' "${files[@]}" | grep -v '^src/python/\|^$' || true)
fi
[ ${#files[@]} -gt 0 ] || { echo "no source differs"; exit 0; }
# a source that differs and includes its own header before all others speaks for both
spoken_for() {
  local own=${1%.hpp}.cpp
  [ "$own" != "$1" ] && printf '%s\n' "${files[@]}" | grep -qx "$own" && grep -m 1 '^#include' "$own" | grep -q "/$(basename "$1")>"
}
alone=()
for file in "${files[@]}"; do
  spoken_for "$file" || alone+=("$file")
done
if [ -n "${most:-}" ] && [ ${#alone[@]} -gt "$most" ]; then
  echo "${#alone[@]} files differ from $2: the $most that changed most are looked at"
  alone=("${alone[@]:0:$most}")
fi
parse() {
  echo "#include \"$1\"" |
    g++ -x c++ - -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Wconversion -Wno-psabi -Wno-unused-function -Werror \
      -Isrc -I. -isystem /usr/include/eigen3 -isystem /usr/include/suitesparse -DEIGEN_MAX_ALIGN_BYTES=32 \
      ${PYTHON_FLAGS:-} '-DWHIRL_VERSION=""' '-DWHIRL_BUILD_TYPE=""'
}
export -f parse
printf '%s\0' "${alone[@]}" | xargs -0 -P "$(nproc)" -I{} bash -c 'parse {}'
