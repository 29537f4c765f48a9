#!/usr/bin/env bash
# Unit tests of the components that handle memory and numbers, and some decks, under the address and undefined-behaviour
# sanitizers. Preset asan: -O1, no VTK; null, alignment, object-size and vptr are left out of the undefined-behaviour checks, for
# they cost a quarter of the compilation and the address sanitizer and the processor find what matters of them.
#   check_sanitized.sh SOURCE
set -euo pipefail
cd "$1"
suites=(core la deck elements system time io)
decks=(01_paper_rotor 06_unbalance_response 21_rub 22_varying_compliance 30_static_sag)

cmake --preset asan -DWHIRL_BUILD_TESTS=ON >/dev/null
cmake --build --preset asan --target whirl "${suites[@]/#/test_}"

export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
export results build=$PWD/build/asan source=$PWD
suite() { cd "$source/tests/$1" && "$build/bin/test_$1" --gtest_brief=1; }
deck() {
  "$build/bin/whirl" run "$source/examples/$1/deck.toml" --quiet --output "$results/$1" --set 'output.vtk=[]' &&
    echo "$1: done"
}
export -f suite deck
printf '%s\n' "${suites[@]/#/suite }" "${decks[@]/#/deck }" | xargs -P "$(nproc)" -I{} bash -c '{}'
