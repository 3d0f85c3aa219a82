#!/bin/bash
#SBATCH --array=1-200 --cpus-per-task=4 --time=04:00:00 --requeue
#SBATCH --signal=B:TERM@60
# Slurm: sbatch shards.sh; once all are done: grashof merge found
export OPENBLAS_NUM_THREADS=1
exec grashof solve mine.toml --effort 100 --out found --workers "$SLURM_CPUS_PER_TASK" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
