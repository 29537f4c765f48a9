#!/usr/bin/env bash
# The Python module: builds it where the tests are built (three files on the libraries that are there), tests it, runs what
# docs/python.md and examples/campbell.py show. Skipped without NumPy or SciPy.
#   check_python.sh SOURCE BUILD PYTHON
set -euo pipefail
source=$(realpath "$1") build=$(realpath "$2") python=$3
"$python" -c 'import numpy, scipy' 2>/dev/null || { echo "no NumPy or SciPy for $python (python3-numpy, python3-scipy)"; exit 77; }
cmake --build "$build" --target whirl_python
export PYTHONPATH="$build/python" PYTHONDONTWRITEBYTECODE=1
"$python" "$source/tests/python/test_whirl.py" "$build/bin/whirl" "$source/examples"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
echo "== docs/python.md"
"$python" - "$source/docs/python.md" <<'PYTHON'
import re, sys
blocks = re.findall(r"```python\n(.*?)```", open(sys.argv[1]).read(), flags=re.S)
assert len(blocks) >= 3
exec("\n".join(blocks), {})
PYTHON
if "$python" -c 'import matplotlib' 2>/dev/null; then
  echo "== examples/campbell.py"
  said=$("$python" "$source/examples/campbell.py")
  echo "$said"
  grep -q 'every list counted: True' <<<"$said"
  file campbell.png | grep -q 'PNG image data, [0-9][0-9]* x'
fi
# installed, the module finds its plug-ins beside it
mkdir -p prefix/lib/python3/dist-packages prefix/lib/whirl
cp "$build"/python/whirl*.so prefix/lib/python3/dist-packages
for plugin in "$build"/plugins/libwhirl_vtk.so; do
  [ -e "$plugin" ] || continue
  cp "$plugin" prefix/lib/whirl
  PYTHONPATH=prefix/lib/python3/dist-packages "$python" -c "
import pathlib, sys, whirl
whirl.load(sys.argv[1]).run('frames')
assert list(pathlib.Path('frames/vtk').glob('*.pvd'))" "$source/examples/30_static_sag/deck.toml"
done
