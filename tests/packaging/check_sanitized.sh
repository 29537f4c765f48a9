#!/usr/bin/env bash
# Unit tests, decks of every kind of step and support, and with WHIRL_MUTANTS decks with wrong keys, under the address and undefined-behaviour sanitizers and with the
# contracts (WHIRL_EXPECTS) checked. Preset asan: clang, a second opinion on the sources, without VTK; null, alignment, object-size, vptr
# and pointer-overflow are left out of the undefined-behaviour checks: the address sanitizer and the processor find what matters of them.
#   check_sanitized.sh SOURCE [SUITE ...]      (or the suites named: elements, time, analysis, app, ...)
set -euo pipefail
cd "$1"
shift
[ $# -gt 0 ] || set -- core la deck meshes system io   # those of elements take as long to compile as all of these together
suites=("$@")
decks=(01_paper_rotor 03_rotating_shaft_benchmark 05_campbell_nelson_mcvaugh 06_unbalance_response 07_internal_damping
       08_asymmetric_shaft 14_torsional_train 20_oil_whirl 21_rub 22_varying_compliance 23_dual_spool 24_geared_pair
       25_casing_on_foundation 26_pad_dynamics 27_misaligned_coupling 28_tilting_pads 30_static_sag 31_column_beyond_buckling 33_double_pendulum)

cmake --preset asan -DWHIRL_BUILD_TESTS=ON >/dev/null
cmake --build --preset asan --target whirl "${suites[@]/#/test_}"

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:exitcode=99 UBSAN_OPTIONS=print_stacktrace=1
# of the kernels that exist once per instruction set the sanitizers watch these (cmake/WhirlComponent.cmake)
if grep -qw avx2 /proc/cpuinfo; then export WHIRL_ISA=avx2; fi
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
export results build=$PWD/build/asan source=$PWD
suite() { cd "$source/tests/$1" && "$build/bin/test_$1" --gtest_brief=1; }
# 4: a list of modes says that it is incomplete; that is for the tests of numbers, which run the release build
deck() {
  local code=0
  "$build/bin/whirl" run "$source/examples/$1/deck.toml" --quiet --output "$results/$1" --set 'output.vtk=[]' || code=$?
  [ $code = 0 ] || [ $code = 4 ] || return 1
  echo "$1: done"
}
export -f suite deck
printf '%s\n' "${suites[@]/#/suite }" "${decks[@]/#/deck }" | xargs -P "$(nproc)" -I{} bash -c '{}'
# WHIRL_MUTANTS=40: decks with wrong keys for so many seconds as well; what has begun then has 10 s more
if [ -n "${WHIRL_MUTANTS:-}" ]; then
  WHIRL_NO_MEMORY_LIMIT=1 python3 tests/app/mutated_keys.py "$build/bin/whirl" examples --seconds "$WHIRL_MUTANTS" --set 'output.vtk=[]'
fi
