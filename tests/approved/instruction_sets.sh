#!/usr/bin/env bash
# Without fused multiplications rounding differs: what is written is to be what was approved all the same.
#   instruction_sets.sh WHIRL EXAMPLES
set -u
whirl=$1 examples=$2
here=$(cd "$(dirname "$0")" && pwd)
dir=$(mktemp -d); trap 'rm -rf "$dir"' EXIT
bad=0
for name in 01_paper_rotor 05_campbell_nelson_mcvaugh 07_internal_damping 08_asymmetric_shaft 30_static_sag 36_api_lateral; do
  WHIRL_ISA=baseline "$whirl" run "$examples/$name/deck.toml" -o "$dir/$name" >"$dir/$name.log" 2>&1 || { echo "$name: exit code $?"; bad=1; }
  python3 "$here/approved.py" "$dir/$name" "$dir/$name.log" "$here/$name.txt" || bad=1
done
exit $bad
