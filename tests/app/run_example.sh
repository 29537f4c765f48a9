#!/usr/bin/env bash
# Runs an example deck through the program and compares numbers of its summary.
#   run_example.sh WHIRL DECK [KEY EXPECTED RELATIVE_TOLERANCE]...
# KEY: first occurrence in summary.json counts. Also: the results that must be there are there, the
# figures can be read, and nothing that is written differs from what was approved (tests/approved).
set -u
whirl=$1 deck=$2; shift 2
dir=$(mktemp -d); trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
"$whirl" run "$deck" >log 2>&1 || { echo "exit code $?"; cat log; exit 1; }
results=$(echo results/*)
for f in summary.json resolved.toml report.html run.json; do
  [ -s "$results/$f" ] || { echo "missing: $f"; exit 1; }
done
if grep -qE '(src|href)="https?:' "$results/report.html"; then echo "report needs the network"; exit 1; fi
bad=0
# fifty figures, each drawn for desks and for telephones, are still sent by mail
if [[ $deck == *02_run_up* ]] && [ "$(stat -c %s "$results/report.html")" -ge 1500000 ]; then
  echo "report of $(stat -c %s "$results/report.html") bytes"
  bad=1
fi
# figures as a reader sees them: nothing leaves its axes, no text stands on another
if command -v python3 >/dev/null && [ -d "$results/plots" ]; then
  python3 "$(dirname "$0")/check_figures.py" "$results/plots" || bad=1
fi
# and what it writes is what was approved
approved=$(dirname "$0")/../approved/$(basename "$(dirname "$deck")").txt
if command -v python3 >/dev/null; then
  python3 "$(dirname "$approved")/approved.py" "$results" log "$approved" || bad=1
fi
while [ $# -ge 3 ]; do
  value=$(grep -F -m1 "\"$1\":" "$results/summary.json" | sed -E 's/.*": ([-+0-9.eE]+).*/\1/')
  awk -v k="$1" -v x="$value" -v e="$2" -v t="$3" 'BEGIN {
    d = x - e; if (d < 0) d = -d; s = e < 0 ? -e : e
    printf "%s = %s, expected %s to %s\n", k, x, e, t
    exit !(x != "" && d <= t * s) }' || bad=1
  shift 3
done
# the resolved deck runs by itself and gives the same
"$whirl" check "$results/resolved.toml" >/dev/null || { echo "resolved deck does not check"; bad=1; }
exit $bad
