#!/usr/bin/env bash
# Fuzzes whatever reads what a user gives (deck, units, tables, foundations, checkpoints, models of other programs), as many at once as
# there are processors, under the address and undefined-behaviour sanitizers. Needs clang.
#   run.sh SOURCE [SECONDS [TARGET ...]]      60 s each
# Always the same inputs in the same order, further the more seconds there are (WHIRL_FUZZ_SEED: others), as long as nothing stands in
# build/asan/corpus. Seeds: the decks, tables and checkpoints of examples and tests, and seeds/. What is found stays in build/asan/found.
set -euo pipefail
cd "$1"
seconds=${2:-60}
shift $(($# > 2 ? 2 : $#))
[ $# -gt 0 ] || set -- deck units tables foundations checkpoints converter

cmake --preset asan -DWHIRL_BUILD_TESTS=ON >/dev/null
cmake --build --preset asan --target "${@/#/fuzz_}"

export build=$PWD/build/asan here=$PWD/tests/fuzz seconds
mkdir -p "$build/found" "$build"/corpus/{deck,units,tables,foundations,checkpoints,converter} "$build/seeds"/{deck,checkpoints}
export ASAN_OPTIONS=detect_stack_use_after_return=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
for deck in examples/*/deck.toml tests/deck/good/*.toml tests/deck/bad/*.toml; do
  cp "$deck" "$build/seeds/deck/$(basename "$(dirname "$deck")")_$(basename "$deck")"
done
# what stands behind the head of a checkpoint, where the release build can write one
whirl=$PWD/build/release/bin/whirl
if [ -x "$whirl" ]; then
  for run in 09_jeffcott_run_up/run_up 12_blade_loss/loss; do
    example=${run%/*}
    "$whirl" run "examples/$example/deck.toml" --quiet --output "$build/seeds/$example" --set 'output.vtk=[]' --set 'output.report=false' \
      --set 'output.csv=false' --set "step.${run#*/}.duration=2 ms"
    for c in "$build/seeds/$example"/checkpoint/*.whirl; do
      [ -f "$c" ] && tail -c +20 "$c" | head -c -8 >"$build/seeds/checkpoints/$example"
    done
  done
fi
fuzz() {
  local seeds=()
  case $1 in
    deck) seeds=("$build/seeds/deck") ;;
    tables | foundations) seeds=("$here/../deck/bad/tables" "$here/../../examples/25_casing_on_foundation" "$here/../../examples/26_pad_dynamics") ;;
    checkpoints) seeds=("$build/seeds/checkpoints") ;;
    *) seeds=("$here/seeds/$1") ;;
  esac
  local log=$build/found/$1.log
  if ! "$build/bin/fuzz_$1" -max_total_time="$seconds" -seed="${WHIRL_FUZZ_SEED:-1}" -timeout=20 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
    -artifact_prefix="$build/found/$1_" "$build/corpus/$1" "${seeds[@]}" >"$log" 2>&1; then
    tail -n 60 "$log"
    echo "fuzz_$1 found something: build/asan/found/$1_*"
    return 1
  fi
  echo "fuzz_$1: $(sed -n 's/^stat::number_of_executed_units: */inputs /p' "$log"), nothing found"
}
export -f fuzz
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'fuzz {}'
