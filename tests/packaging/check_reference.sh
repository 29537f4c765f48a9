#!/usr/bin/env bash
# docs/deck.md and docs/deck are what the program writes, and nothing else stands there.
#   check_reference.sh WHIRL DOCS
set -euo pipefail
written=$(mktemp -d)
trap 'rm -rf "$written"' EXIT
"$1" schema --pages "$written"
diff "$written/deck.md" "$2/deck.md" && diff -r "$written/deck" "$2/deck" ||
  { echo "write it anew: whirl schema --pages docs"; exit 1; }
