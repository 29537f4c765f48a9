#!/usr/bin/env bash
# The Debian packages of a build: what they depend on is what they link, and the program installed from them into an empty
# root runs there with nothing but the libraries of its dependencies.
#   check_deb.sh BUILD
set -euo pipefail
build=$1
for tool in cpack dpkg-deb dpkg-shlibdeps readelf; do
  command -v "$tool" >/dev/null || { echo "$tool is not installed"; exit 77; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
(cd "$build" && cpack -G DEB -B "$scratch/work" -D CPACK_OUTPUT_FILE_PREFIX="$scratch/packages") >"$scratch/cpack.log" 2>&1 || { cat "$scratch/cpack.log"; exit 1; }
cd "$scratch"

field() { dpkg-deb -f "$1" "$2"; }
# Package a library belongs to; /lib is a link to /usr/lib.
owner() { (dpkg -S "$(readlink -f "$1")" 2>/dev/null || dpkg -S "$1" 2>/dev/null || dpkg -S "${1#/usr}") | sed -E 's/:.*//;q'; }

# Every library a file of the package links belongs to a package it depends on.
check_links() {
  local deb=$1 root=$2 file library path package depends
  depends=$(field "$deb" Depends | sed -E 's/ *\([^)]*\)//g; s/ *[,|] */\n/g')   # one name a line
  while read -r file; do
    for library in $(readelf -d "$file" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p'); do
      path=$(ldd "$file" | awk -v l="$library" '$1 == l { print $3 }')
      [ -n "$path" ] || path=$(ldd "$file" | awk -v l="$library" 'index($1, "/" l) { print $1 }')
      package=$(owner "$path")
      grep -qFx -- "$package" <<<"$depends" ||
        { echo "$deb links $library of $package and does not depend on it: $depends"; exit 1; }
    done
  done < <(find "$root" -type f \( -path '*/bin/*' -o -name '*.so' \))
}

mkdir unpacked
for deb in packages/*.deb; do
  name=$(field "$deb" Package)
  dpkg-deb -x "$deb" "unpacked/$name"
  check_links "$deb" "unpacked/$name"
  echo "$(basename "$deb"): $(du -h "$deb" | cut -f1); depends on $(field "$deb" Depends)"
done
whirl=$(ls packages/whirl_*.deb)
for plugin in "$build"/plugins/libwhirl_*.so; do
  [ -e "$plugin" ] || continue
  name=whirl-$(basename "$plugin" .so | sed 's/libwhirl_//')
  ls packages/"${name}"_*.deb >/dev/null
  grep -qw -- "$name" <<<"$(field "$whirl" Recommends)" || { echo "whirl does not recommend $name"; exit 1; }
done
if grep -qiE 'vtk|hdf5|sundials|mpi' <<<"$(field "$whirl" Depends)"; then
  echo "the program depends on what plug-ins use: $(field "$whirl" Depends)"
  exit 1
fi
[ -s unpacked/libwhirl-dev/usr/lib/cmake/whirl/whirl-config.cmake ] || [ -n "$(ls unpacked/libwhirl-dev/usr/lib/*/cmake/whirl)" ]

if [ "$(id -u)" != 0 ]; then
  echo "not root: the packages are unpacked, not installed"
  unpacked/whirl/usr/bin/whirl version
  exit 0
fi
root=$scratch/root
mkdir -p "$root/var/lib/dpkg/updates" "$root/var/lib/dpkg/info" "$root/dev" "$root/proc" "$root/tmp"
touch "$root/var/lib/dpkg/status"
dpkg --root="$root" --force-depends --force-script-chrootless -i "$whirl" >/dev/null 2>"$scratch/dpkg.log" ||
  { cat "$scratch/dpkg.log"; exit 1; }
# the libraries of its dependencies
for path in $(ldd "$root/usr/bin/whirl" | grep -oE '/[^ ]+'); do
  mkdir -p "$root$(dirname "$path")"
  cp -L "$path" "$root$path"
done
chroot "$root" /usr/bin/whirl version
chroot "$root" /usr/bin/whirl new --example 30_static_sag /tmp/deck.toml >/dev/null
chroot "$root" /usr/bin/whirl run /tmp/deck.toml --quiet --output /tmp/results --set 'output.vtk=[]'
[ -s "$root/tmp/results/summary.json" ]
# frames without their plug-in: an error that names it
if chroot "$root" /usr/bin/whirl run /tmp/deck.toml --quiet --output /tmp/frames 2>"$scratch/message"; then
  echo "frames were written without the plug-in"
  exit 1
fi
grep -q "vtk" "$scratch/message"
dpkg --root="$root" --force-depends --force-script-chrootless -r whirl >/dev/null 2>&1
[ ! -e "$root/usr/bin/whirl" ]
