#!/usr/bin/env bash
# A sweep as a Slurm array: every task does its share of the runs, in one folder that all nodes see, and the last one to finish
# writes the table. A task that was killed is submitted again; what it had finished is kept.
#   sbatch --array=1-8 --cpus-per-task=4 examples/sweep_on_slurm.sh deck.toml -o sweep --vary .. --response ..
#SBATCH --job-name=whirl-sweep
#SBATCH --time=12:00:00
set -euo pipefail
exec "${WHIRL:-whirl}" sweep "$@" --shard auto --resume --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet
