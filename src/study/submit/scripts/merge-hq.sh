#!/usr/bin/env bash
# Waits for a job and puts its shards together, written by `fretwear submit`: bash merge-hq.sh JOB
fretwear=@PROGRAM@
folder=@FOLDER@
merged=@MERGED@

job=${1:?the number of the job that submit.sh printed}
# A failed task makes this fail too; what counts is what lies in the folder.
hq job wait "$job" || true
"$fretwear" merge "$folder" -o "$merged" --force
code=$?
if [ "$code" -eq 1 ]; then
    # Exit code 75, a checkpoint, is a failure in HyperQueue's eyes; handed in again, a task does only what is missing.
    echo "Hand in again what is left: bash $(printf %q "$folder/submit.sh") --array=\"\$(hq job task-ids $job --filter=failed,canceled)\"" >&2
fi
exit "$code"
