#!/bin/sh
# The program itself links none of the big libraries: they come in as plug-ins when a deck asks for them.
set -eu
needed=$(readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p')
[ -n "$needed" ] || { echo "readelf found no libraries in $1"; exit 1; }
for library in $needed; do
  case $library in
    *vtk* | *VTK* | *sundials* | *hdf5* | *mpi* | *python*) echo "$1 links $library"; exit 1 ;;
  esac
done
# what is mapped while a run without frames goes on: the dynamic linker's own list
loaded=$(LD_DEBUG=files "$1" run "$2" --quiet --output "$3" 2>&1 | sed -n 's/.*file=\([^ ]*\).*generating link map.*/\1/p' | sort -u)
for library in $loaded; do
  case $library in
    *vtk* | *VTK* | *sundials* | *hdf5*) echo "running $2 loads $library"; exit 1 ;;
  esac
done
rm -rf "$3"
