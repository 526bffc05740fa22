#!/usr/bin/env bash
# Hands sweep.sbatch in, and merge.sbatch to follow it, written by `fretwear submit`. Options go to sbatch and overrule the script's:
#     bash submit.sh --array=3,17       only these shards, then the merge
# Prints the numbers of the two jobs.
set -euo pipefail
cd -- @FOLDER@
mkdir -p log
array=$(sbatch --parsable "$@" sweep.sbatch)
# With several clusters the answer is NUMBER;CLUSTER.
array=${array%%;*}
merge=$(sbatch --parsable --dependency="afterany:$array" merge.sbatch)
echo "$array ${merge%%;*}"
