#!/usr/bin/env bash
# Every source of the product parses without a warning under -Wall -Wextra -Wshadow -Wconversion -Werror, each by itself: a
# missing #include that the precompiled headers hide fails here too. Warnings that need optimisation are the builds' own.
#   check_warnings.sh SOURCE
set -euo pipefail
cd "$1"
git ls-files 'src/*.cpp' 'elements/*.cpp' 'meshes/*.cpp' | grep -v '/sundials/\|/vtk/\|/hdf5/' |
  xargs -P "$(nproc)" -I{} g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Wconversion -Wno-psabi -Werror \
    -Isrc -I. -isystem /usr/include/eigen3 -isystem /usr/include/suitesparse -DEIGEN_MAX_ALIGN_BYTES=32 \
    '-DWHIRL_VERSION=""' '-DWHIRL_BUILD_TYPE=""' {}
