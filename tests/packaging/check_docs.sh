#!/usr/bin/env bash
# The manual (docs/Doxyfile) builds without a warning, and the files that pages name exist.
#   check_docs.sh SOURCE
set -euo pipefail
bad=0
while IFS=: read -r page path; do
  compgen -G "$1/$path" >/dev/null || { echo "$page names $path, which does not exist"; bad=1; }
done < <(cd "$1" && grep -oE '`(src|elements|meshes|tests|docs|cmake|examples)/[A-Za-z0-9_./*-]+`' \
           README.md CONTRIBUTING.md docs/*.md docs/developer/*.md docs/adr/*.md | tr -d '`' | sort -u)
[ $bad = 0 ] || exit 1
command -v doxygen >/dev/null || { echo "doxygen is not installed"; exit 77; }
WHIRL_DOCS_OUTPUT=$(mktemp -d)
export WHIRL_DOCS_OUTPUT
trap 'rm -rf "$WHIRL_DOCS_OUTPUT"' EXIT
cd "$1"
doxygen docs/Doxyfile
[ -s "$WHIRL_DOCS_OUTPUT/html/index.html" ]
