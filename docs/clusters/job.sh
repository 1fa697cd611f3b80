#!/bin/sh
# One SLURM job that brings its own cluster: sbatch --ntasks=64 --time=4:00:00 job.sh mine.toml DIR
# A job that was ended goes on when it is sent again.
#SBATCH --signal=B:TERM@120
set -eu
file="${TMPDIR:-$PWD}/scheduler-${SLURM_JOB_ID:-0}.json"
dask scheduler --scheduler-file "$file" --no-dashboard &
srun dask worker --scheduler-file "$file" --nthreads 1 --no-dashboard &
trap 'kill "$run"; wait "$run"' TERM
lepp-study run "$2" --config "$1" --scheduler-file "$file" &
run=$!
wait "$run"
