#!/usr/bin/env bash
# Exit codes and the shape of messages, as a user's scripts see them.
set -u
whirl=$1
dir=$(mktemp -d); trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
bad=0
expect() {   # code, text that must be in the output, command
  local code=$1 text=$2; shift 2
  local out; out=$("$@" 2>&1); local rc=$?
  if [ $rc -ne "$code" ]; then echo "exit $rc instead of $code: $*"; echo "$out" | head -5; bad=1; fi
  if ! grep -qF -- "$text" <<<"$out"; then echo "no '$text' in the output of: $*"; echo "$out" | head -8; bad=1; fi
}
expect 2 "deck is required" "$whirl" run
expect 2 "" "$whirl" nonsense
expect 5 "missing.toml" "$whirl" run missing.toml
expect 0 "Whirl" "$whirl" --help
printf 'format = 1\n[shaft]\nmaterial = "steel"\ncolumns = ["length[mm]", "od[mm]"]\nrows = [[500, 20]]\n[[disk]]\nname = "d"\nat = "0.9 m"\nmass = 3\nIq = "1 kg.m^2"\n' > bad.toml
expect 3 "bad.toml:8" "$whirl" check bad.toml
expect 3 "Iq" "$whirl" check bad.toml
expect 3 "mass = 3" "$whirl" check bad.toml
: > empty.toml
expect 3 "empty.toml" "$whirl" check empty.toml
expect 0 "" "$whirl" explain E07
exit $bad
