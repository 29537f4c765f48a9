#!/usr/bin/env bash
# A sweep as a Slurm array on a cluster of one node that this script brings up in a temporary folder: munged, slurmctld and slurmd, on
# ports of their own. The first array is cancelled on its way, the second one goes on; the table is that of a plain sweep, byte for byte.
#   slurm.sh WHIRL SOURCE      exit code 77: slurmctld, slurmd or munged is missing (Debian: slurm-wlm, munge)
set -euo pipefail
PATH=$PATH:/usr/sbin
whirl=$(realpath "$1")
source=$(realpath "$2")
for tool in munged slurmctld slurmd sbatch scancel squeue; do
  command -v $tool >/dev/null || { echo "$tool is missing"; exit 77; }
done

work=$(mktemp -d)
chmod 755 "$work"
started=()
finish() {
  for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${started[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap finish EXIT
cd "$work"
start() {   # name, command ..
  local name=$1
  shift
  "$@" >"$name.out" 2>&1 &
  started+=($!)
}
wait_until() {   # seconds, command ..
  local left=$(($1 * 5))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $((left--)) -gt 0 ] || { echo "not in time: $*"; tail -n 20 ./*.out ./*.log; exit 1; }
    sleep 0.2
  done
}

mkdir munge state spool
chmod 700 munge
head -c 1024 /dev/urandom >munge/key
chmod 400 munge/key
start munged munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge.socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" --num-threads=2
wait_until 20 test -S munge.socket

port=$((20000 + RANDOM % 20000))
host=$(hostname -s)
cat >slurm.conf <<CONF
ClusterName=whirl_test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2
KillWait=2
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf WHIRL=$whirl
start slurmctld slurmctld -D -f "$SLURM_CONF"
start slurmd slurmd -D -f "$SLURM_CONF" -N "$host"
idle() { sinfo --noheader --format=%T | grep -q idle; }
wait_until 60 idle

cp "$source/examples/34_tolerances/deck.toml" .
sweep=(deck.toml --samples 400)
array() { sbatch --array=3-6 --cpus-per-task=1 --chdir="$work" --output="$work/task_%a.out" "$@" "$source/examples/sweep_on_slurm.sh" "${sweep[@]}" -o array; }

first=$(array --parsable)
some_rows() { [ "$(cat array/shard_*/rows.tsv | wc -l)" -ge 20 ]; }
wait_until 60 some_rows
scancel --full "$first"
gone() { [ -z "$(squeue --noheader)" ]; }
wait_until 60 gone
kept=$(cat array/shard_*/rows.tsv | wc -l)
[ "$kept" -lt 400 ] || { echo "all runs were done before the array was cancelled"; exit 1; }
[ ! -e array/sweep.csv ] || { echo "a table of $kept runs of 400"; exit 1; }

array --wait >/dev/null || { cat task_*.out; exit 1; }
"$whirl" sweep "${sweep[@]}" -o plain --quiet
cmp array/sweep.csv plain/sweep.csv
cmp array/statistics.csv plain/statistics.csv
folders=(array/shard_*_of_4)
[ ${#folders[@]} = 4 ] || { echo "${#folders[@]} shards instead of 4"; exit 1; }
echo "400 runs by 4 tasks of Slurm $(slurmctld -V | cut -d' ' -f2), $kept of them before they were cancelled: the table of a plain sweep"
