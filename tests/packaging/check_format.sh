#!/usr/bin/env bash
# Every C++ file stands as clang-format (14, the root's .clang-format) writes it.
#   check_format.sh SOURCE
set -euo pipefail
cd "$1"
command -v clang-format >/dev/null || { echo "clang-format is not installed"; exit 77; }
find src elements meshes tests cmake \( -name '*.cpp' -o -name '*.hpp' -o -name '*.inl' \) -print0 |
  xargs -0 -n 32 -P "$(nproc)" clang-format --dry-run -Werror
