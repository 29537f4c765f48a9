#!/usr/bin/env bash
# Approves what the program writes today: look at the differences (git diff) before they are committed.
#   update.sh WHIRL [NAME...]    all decks, or those of these names ("21_rub", "starter_fan", "messages")
set -eu
whirl=$(realpath "$1"); shift
here=$(cd "$(dirname "$0")" && pwd)
examples=$(realpath "$here/../../examples")
dir=$(mktemp -d); trap 'rm -rf "$dir"' EXIT
wanted() { [ $# -gt 1 ] || return 0; local name=$1 x; shift; for x; do [ "$x" != "$name" ] || return 0; done; return 1; }

approve() {  # NAME DECK
  "$whirl" run "$2" -o "$dir/$1" >"$dir/$1.log" 2>&1 || true
  WHIRL_ISA=baseline "$whirl" run "$2" -o "$dir/$1.other" >"$dir/$1.other.log" 2>&1 || true
  python3 "$here/approved.py" "$dir/$1" "$dir/$1.log" "$here/$1.txt" --write "$dir/$1.other" "$dir/$1.other.log"
}

for deck in "$examples"/*/deck.toml; do
  name=$(basename "$(dirname "$deck")")
  wanted "$name" "$@" && approve "$name" "$deck"
done
for machine in compressor fan flywheel gas_turbine geared motor pump spindle train turbocharger vertical_pump; do
  wanted "starter_$machine" "$@" || continue
  "$whirl" new --machine "$machine" "$dir/$machine.toml" >/dev/null 2>&1
  approve "starter_$machine" "$dir/$machine.toml"
done
if wanted messages "$@"; then python3 "$here/messages.py" "$whirl" "$examples" "$here/messages.txt" --write; fi
