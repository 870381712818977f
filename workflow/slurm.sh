#!/usr/bin/env bash
# A planned scene through all stages as plain arrays of Slurm, without another engine:
#
#   colod plan INPUT... -o WORK/plan.json --cells N [options]
#   workflow/slurm.sh WORK/plan.json OUT [SHARDS] [options of colod export]
#
# SHARDS (default: the plan's cells) is the size of the arrays; each task takes every SHARDS-th cell (SLURM_ARRAY_TASK_ID). Prints the
# number of the last job, whose end is the scene's. COLOD, THREADS and MEMORY (MiB) of a task come from the environment. A task that
# failed or was killed is started again alone: sbatch --array=K …, then the later stages; what is done is passed over.
set -euo pipefail
if [ $# -lt 2 ]; then
  sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
plan=$1 out=$2
cells=$(python3 -c 'import json, sys; print(len(json.load(open(sys.argv[1]))["cells"]))' "$plan")
shards=${3:-$cells}
shift $(($# < 3 ? $# : 3))
colod=${COLOD:-colod} threads=${THREADS:-1} memory=${MEMORY:-4096}
logs=$(dirname "$plan")/logs
mkdir -p "$logs"
stage() {  # NAME SBATCH-OPTIONS -- ARGUMENTS: a building that failed (exit code 1) ends no workflow
  local name=$1 options=()
  shift
  while [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  shift
  sbatch --parsable --job-name="colod-$name" --cpus-per-task="$threads" --mem="$memory" "${options[@]}" \
    --wrap="$(printf '%q ' "$colod" "$name" --plan "$plan" --threads "$threads" "$@") || [ \$? -eq 1 ]"
}
segment=$(stage segment --array="0-$((shards - 1))" --output="$logs/segment-%a.log" --)
analyze=$(stage analyze --dependency="afterok:$segment" --kill-on-invalid-dep=yes --output="$logs/analyze.log" --)
mesh=$(stage mesh --array="0-$((shards - 1))" --dependency="afterok:$analyze" --kill-on-invalid-dep=yes --output="$logs/mesh-%a.log" --)
export=$(stage export --array="0-$((shards - 1))" --dependency="afterok:$mesh" --kill-on-invalid-dep=yes --output="$logs/export-%a.log" -- -o "$out" "$@")
stage merge --dependency="afterok:$export" --kill-on-invalid-dep=yes --output="$logs/merge.log" -- -o "$out" "$@"
