#!/usr/bin/env bash
# Who may include whom. Elements never see model, mesh or deck; analyses never see elements; nothing points backwards.
set -u
cd "$1" || exit 2
declare -A may=(
  [core]="core"
  [la]="core la"
  [model]="core model"
  [deck]="core la model deck"
  [time]="core time"
  [system]="core la time system"
  [meshes]="core model meshes"
  [elements]="core la system elements"
  [assembly]="core la model meshes system elements assembly"
  [plot]="core meshes model plot"
  [io]="core meshes model plot io"
  [analysis]="core la time system analysis"
  [run]="core la model deck time system meshes assembly io analysis run"
  [results]="core la model time system meshes assembly plot io analysis run results"
  [steps]="core la model time system meshes assembly plot io analysis run results steps"
  [python]="core la model deck system meshes assembly io analysis run results steps python"
  [study]="core la model deck time system meshes assembly plot io analysis run results steps study"
  [sweep]="core model deck plot io run steps sweep"
  [convert]="core deck io convert"
  [app]="core model deck meshes assembly plot io run steps study sweep convert app"
)
bad=0
for folder in src/* elements meshes; do
  [ -d "$folder" ] || continue
  component=${folder##*/}
  if [ -z "${may[$component]:-}" ]; then
    echo "$folder has no rule in $0"
    bad=1
    continue
  fi
  grep -rnE "#include [<\"]($(IFS='|'; echo "${!may[*]}"))/" "$folder" --include='*.hpp' --include='*.cpp' --include='*.inl' |
    awk -v component="$component" -v may=" ${may[$component]} " '
      match($0, /[<"][a-z]+\//) {
        to = substr($0, RSTART + 1, RLENGTH - 2)
        if (index(may, " " to " ")) next
        sub(/:#include/, ": " component " may not include " to ": #include")
        print
        bad = 1
      }
      END { exit bad }' || bad=1
done
# libraries with one door each
for rule in 'vtk:src/io/vtk' 'ida/|arkode/|sundials/:src/time/sundials' 'klu\.h|amd\.h:src/la' 'toml\+\+:src/deck/text' \
            'CLI/:src/app' 'nlohmann/:src/io/json.cpp' 'hdf5\.h:src/io/hdf5' 'png\.h:src/plot' 'sha2\.h:src/run' 'mpi\.h:src/sweep/mpi' \
            'pybind11/:src/python'; do
  pattern=${rule%:*} home=${rule##*:}
  if out=$(grep -rnE "#include <($pattern)" src elements meshes --include='*.hpp' --include='*.cpp' | grep -vE "^$home[/:]"); then
    echo "only $home may include $pattern:"
    echo "$out"
    bad=1
  fi
done
# nothing undeclared: every folder of sources belongs to a component
for folder in $(find src elements meshes -name '*.cpp' -printf '%h\n' | sort -u); do
  case $folder in
    src/*/*/* | elements/*/*) echo "$folder: a component has one level of sub-folders"; bad=1 ;;
  esac
done
exit $bad
