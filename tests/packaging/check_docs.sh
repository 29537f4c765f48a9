#!/usr/bin/env bash
# The manual (docs/Doxyfile) builds without a warning.
#   check_docs.sh SOURCE
set -euo pipefail
command -v doxygen >/dev/null || { echo "doxygen is not installed"; exit 77; }
WHIRL_DOCS_OUTPUT=$(mktemp -d)
export WHIRL_DOCS_OUTPUT
trap 'rm -rf "$WHIRL_DOCS_OUTPUT"' EXIT
cd "$1"
doxygen docs/Doxyfile
[ -s "$WHIRL_DOCS_OUTPUT/html/index.html" ]
