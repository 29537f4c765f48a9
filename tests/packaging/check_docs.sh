#!/usr/bin/env bash
# The manual (docs/Doxyfile) builds without a warning or a broken link; the files and links that pages name exist; the gallery
# holds every example; what pages quote stands there.
#   check_docs.sh SOURCE
set -euo pipefail
bad=0
while IFS=: read -r page path; do
  compgen -G "$1/$path" >/dev/null || { echo "$page names $path, which does not exist"; bad=1; }
done < <(cd "$1" && grep -roE '`(src|elements|meshes|tests|docs|cmake|examples)/[A-Za-z0-9_./*-]+`' \
           README.md CONTRIBUTING.md docs --include='*.md' | tr -d '`' | sort -u)
[ $bad = 0 ] || exit 1
cd "$1"
python=$(command -v python3 || true)
if [ -n "$python" ]; then
  "$python" tests/packaging/check_links.py .
  "$python" tests/packaging/gallery.py --check .
  "$python" tests/packaging/run_guide.py --quotes docs/developer/library.md tests/packaging/consumer
fi
command -v doxygen >/dev/null || { echo "doxygen is not installed"; exit 77; }
WHIRL_DOCS_OUTPUT=$(mktemp -d)
export WHIRL_DOCS_OUTPUT
trap 'rm -rf "$WHIRL_DOCS_OUTPUT"' EXIT
doxygen docs/Doxyfile
[ -s "$WHIRL_DOCS_OUTPUT/html/index.html" ]
[ -z "$python" ] || "$python" tests/packaging/check_links.py --html "$WHIRL_DOCS_OUTPUT/html"
