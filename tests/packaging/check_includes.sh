#!/usr/bin/env bash
# Who may include whom. Elements never see model, mesh or deck; analyses never see elements; nothing points backwards.
set -u
cd "$1" || exit 2
declare -A may=(
  [core]="core" [la]="core la" [model]="core model" [deck]="core model deck" [meshes]="core model meshes"
  [time]="core time" [system]="core la time system" [elements]="core system elements"
  [assembly]="core la model meshes system elements assembly" [io]="core meshes io model" [analysis]="core la time system analysis"
)
bad=0
for c in "${!may[@]}"; do
  dir=src/$c; [ -d "$dir" ] || dir=$c; [ -d "$dir" ] || continue
  while IFS=: read -r file line text; do
    to=$(sed -E 's/.*<([a-z]+)\/.*/\1/' <<<"$text")
    case " ${may[$c]} " in *" $to "*) ;; *) echo "$file:$line: $c may not include $to: $text"; bad=1 ;; esac
  done < <(grep -rnE '#include [<"](core|la|model|deck|meshes|time|system|elements|assembly|io|analysis|app)/' "$dir" --include='*.hpp' --include='*.cpp' --include='*.inl')
done
# libraries with one door each
for rule in 'vtk:src/io/vtk' 'ida/|arkode/|sundials/:src/time/sundials' 'klu\.h|amd\.h|Spectra/:src/la' 'toml\+\+:src/deck' 'CLI/:src/app' 'nlohmann/:src/io' 'hdf5\.h:src/io/hdf5'; do
  pattern=${rule%:*} home=${rule##*:}
  if out=$(grep -rnE "#include <($pattern)" src elements meshes --include='*.hpp' --include='*.cpp' | grep -v "^$home/"); then
    echo "only $home may include $pattern:"; echo "$out"; bad=1
  fi
done
exit $bad
