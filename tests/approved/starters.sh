#!/usr/bin/env bash
# Runs the starters of `whirl new --machine` and holds what they write against what was approved.
#   starters.sh WHIRL
set -u
whirl=$1
here=$(cd "$(dirname "$0")" && pwd)
dir=$(mktemp -d); trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
bad=0
for approved in "$here"/starter_*.txt; do
  machine=$(basename "$approved" .txt); machine=${machine#starter_}
  "$whirl" new --machine "$machine" "$machine.toml" >/dev/null 2>&1 &&
    "$whirl" run "$machine.toml" -o "$machine" >"$machine.log" 2>&1 || { echo "$machine: exit code $?"; bad=1; }
  python3 "$here/approved.py" "$machine" "$machine.log" "$approved" || bad=1
done
exit $bad
