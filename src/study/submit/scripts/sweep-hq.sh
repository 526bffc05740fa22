#!/usr/bin/env bash
# One shard of a sweep for each task of the array, written by `fretwear submit`. Edit it freely and hand it in with submit.sh.
# HyperQueue stops a task with SIGINT and, one second later, SIGKILL: the program takes the place of this shell so that it hears the
# first, and checkpoints come often so that the second costs little.
fretwear=@PROGRAM@
study=@STUDY@
folder=@FOLDER@
# Fixed: the same shards whichever of them are handed in again.
shards=@SHARDS@

task=${HQ_TASK_ID:?run this through hq submit}
exec "$fretwear" sweep "$study" -o "$folder" --shard "$task/$shards" --threads @CPUS@ --checkpoint-interval @INTERVAL@ --quiet \
    >>"$folder/log/sweep-hq_$task.log" 2>&1
