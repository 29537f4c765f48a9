#!/usr/bin/env bash
# A sweep over two ranks of Open MPI, and every run of it, under valgrind: no read of what was never written, none
# beyond what was asked for. What PMIx sends of its own padding is not counted.
#   mpi_under_valgrind.sh WHIRL      exit code 77: mpirun, valgrind or the component is missing
set -euo pipefail
whirl=$(realpath "$1")
command -v valgrind >/dev/null && command -v mpirun >/dev/null || exit 77
"$whirl" version | grep -q mpi || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >deck.toml <<'DECK'
format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["left", 500, 20, 3], ["right", 500, 20, 3]]
[[disk]]
name = "disk"
at = "left:end"
mass = "3 kg"
Ip = "0.015 kg.m^2"
Id = "0.0075 kg.m^2"
[[bearing]]
name = "DE"
at = "left:start"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "8e5 N/m"
[[bearing]]
name = "NDE"
at = "right:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "8e5 N/m"
[[step]]
name = "m"
type = "modal"
speed = "3000 rpm"
modes = 4
DECK
cat >pmix.supp <<'SUPP'
{
   PMIx sends its padding
   Memcheck:Param
   writev(vector[...])
   ...
   fun:pmix_ptl_base_send_handler
}
SUPP
# instructions that valgrind knows
export WHIRL_ISA=baseline GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
known=(--suppressions="$work/pmix.supp")
[ -f /usr/share/openmpi/openmpi-valgrind.supp ] && known+=(--suppressions=/usr/share/openmpi/openmpi-valgrind.supp)
mpirun --oversubscribe -n 2 valgrind --error-exitcode=9 --leak-check=no --log-file="$work/log.%p" "${known[@]}" \
  "$whirl" sweep deck.toml --vary "bearing.DE.kyy=5e5N/m:2e6N/m:4" --response "f=m_modes:frequency [Hz]:1" -q -j 1 \
  --output out || { cat log.*; exit 1; }
logs=(log.*)
[ "${#logs[@]}" -ge 6 ]   # two ranks, four runs
grep -L 'ERROR SUMMARY: 0 errors' log.* | grep . && exit 1
rows=$(grep -c '^[0-9]' out/sweep.csv)
[ "$rows" -eq 4 ] || { echo "$rows rows instead of 4"; exit 1; }
