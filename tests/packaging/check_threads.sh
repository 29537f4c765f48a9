#!/usr/bin/env bash
# Whatever works side by side, under the thread sanitizer (preset tsan): tasks on threads, the thread that writes frames, steps of
# many kinds with --jobs 4, and a small sweep in processes. HDF5 and VTK are not built with it and stay out.
#   check_threads.sh SOURCE
set -euo pipefail
cd "$1"
cmake --preset tsan -DWHIRL_BUILD_TESTS=ON -DWHIRL_WITH_HDF5=OFF >/dev/null
cmake --build --preset tsan --target whirl test_core test_io

export TSAN_OPTIONS=halt_on_error=1:exitcode=66:second_deadlock_stack=1
bin=$PWD/build/tsan/bin
source=$PWD
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
run() {   # name, command ..: an exit code of 4 says that a list of modes is not complete
  local name=$1 code=0
  shift
  "$@" >"$results/log" 2>&1 || code=$?
  if { [ $code != 0 ] && [ $code != 4 ]; } || grep -q ThreadSanitizer "$results/log"; then
    cat "$results/log"
    echo "$name: exit code $code"
    exit 1
  fi
  echo "$name: no race"
}

run "tasks side by side" "$bin/test_core" --gtest_filter='SideBySide.*' --gtest_repeat=20
run "queued frames" "$bin/test_io" --gtest_filter='QueuedFrames.*' --gtest_repeat=5
decks=(05_campbell_nelson_mcvaugh 06_unbalance_response 08_asymmetric_shaft 14_torsional_train 20_oil_whirl 23_dual_spool 24_geared_pair
       27_misaligned_coupling 30_static_sag)
for deck in "${decks[@]}"; do
  run "$deck" "$bin/whirl" run "$source/examples/$deck/deck.toml" --jobs 4 --quiet --output "$results/$deck" --set 'output.vtk=[]'
done
run "sweep" "$bin/whirl" sweep "$source/examples/34_tolerances/deck.toml" --samples 8 --jobs 4 --quiet --output "$results/sweep"
