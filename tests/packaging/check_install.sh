#!/usr/bin/env bash
# What `cmake --install` leaves in a scratch prefix (with spaces in its name) is complete and works by itself: the program
# finds its plug-ins there, completions load, every public header compiles, and a program of one's own builds against it.
#   check_install.sh SOURCE BUILD
set -euo pipefail
source=$1 build=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
prefix="$scratch/a prefix with spaces"
cmake --install "$build" --prefix "$prefix" >"$scratch/install.log" || { cat "$scratch/install.log"; exit 1; }
for file in bin/whirl share/man/man1/whirl.1 share/bash-completion/completions/whirl \
            share/fish/vendor_completions.d/whirl.fish include/whirl/core/error.hpp include/whirl/elements/rigid/rigid_body.hpp; do
  [ -s "$prefix/$file" ] || { echo "not installed: $file"; exit 1; }
done
bash -n "$prefix/share/bash-completion/completions/whirl"
if out=$(grep -rlF "$build" "$prefix" --include='*.cmake'); then
  echo "names of the build folder in: $out"
  exit 1
fi

echo "== the program, away from its sources"
cd "$scratch"
whirl="$prefix/bin/whirl"
"$whirl" --version
"$whirl" new --example 30_static_sag deck.toml >/dev/null
"$whirl" run deck.toml --quiet --output results
[ -s results/summary.json ]
# a plug-in of the build must be found beside the installed program
for plugin in "$build"/plugins/libwhirl_*.so; do
  [ -e "$plugin" ] || continue
  name=$(basename "$plugin" .so)
  name=${name#libwhirl_}
  grep -q "$name yes" <<<"$("$whirl" version)" || { echo "plug-in $name is not found"; exit 1; }
done
if [ -e "$build/plugins/libwhirl_vtk.so" ]; then
  ls results/vtk/*.pvd >/dev/null
fi

echo "== every public header by itself in one program, and the example of the library"
cp -r "$source/tests/packaging/consumer" consumer
(cd "$prefix/include/whirl" && find . -name '*.hpp' -printf '#include <%P>\n' | sort) >consumer/headers.cpp
echo 'add_library(headers OBJECT headers.cpp)
target_link_libraries(headers PRIVATE whirl::whirl)' >>consumer/CMakeLists.txt
cmake -S consumer -B consumer/build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release
cmake --build consumer/build
consumer/build/spinning_shaft
